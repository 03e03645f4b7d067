//! Drawings as people have them, through `nest`: each comes in whole and at its size, and
//! what is left out is told. Expected values are the dimensions that were drawn.

use std::process::Command;

/// What `nest` makes of a drawing.
#[derive(Debug)]
struct Nested {
    /// Width and height of each part, in tenths of a millimetre, in order of size.
    sizes: Vec<[i64; 2]>,
    /// Area of each part without its holes, mm², in the same order.
    areas: Vec<f64>,
    holes: usize,
    said: String,
    code: Option<i32>,
    /// The first sheet as DXF.
    sheet: String,
}

fn nested_as(file: &str, bytes: &[u8], words: &[&str]) -> Nested {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join(file), bytes).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_finwright"));
    command.current_dir(place.path()).args(["nest", file, "-o", "out"]).args(words);
    let command = command.args(["--sheet", "600x400", "--effort", "quick"]);
    let ran = command.output().unwrap();
    let text = |path: &str| std::fs::read_to_string(place.path().join(path));
    let layout = text("out/layout.json").unwrap_or_default();
    let layout: serde_json::Value = serde_json::from_str(&layout).unwrap_or_default();
    let none = Vec::new();
    let list = |value: &serde_json::Value| value.as_array().unwrap_or(&none).clone();
    let ring = |value: &serde_json::Value| -> Vec<[f64; 2]> {
        let number = |p: &serde_json::Value, k: usize| p[k].as_f64().unwrap();
        list(value).iter().map(|p| [number(p, 0), number(p, 1)]).collect()
    };
    let (mut parts, mut holes) = (Vec::new(), 0);
    for part in list(&layout["parts"]) {
        let outline = ring(&part["outline"]);
        let inner: Vec<f64> =
            list(&part["holes"]).iter().map(|hole| area(&ring(hole))).collect();
        holes += inner.len();
        let count = part["quantity"].as_u64().unwrap_or(1);
        let part = (size(&outline), area(&outline) - inner.iter().sum::<f64>());
        parts.extend(vec![part; count as usize]);
    }
    parts.sort_by_key(|part| part.0);
    let (sizes, areas) = parts.into_iter().unzip();
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    let sheet = text("out/sheets/sheet-01.dxf").unwrap_or_default();
    Nested { sizes, areas, holes, said, code: ran.status.code(), sheet }
}

fn size(ring: &[[f64; 2]]) -> [i64; 2] {
    [0, 1].map(|axis| {
        let along = || ring.iter().map(|p| p[axis]);
        let width = along().fold(f64::MIN, f64::max) - along().fold(f64::MAX, f64::min);
        (width * 10.0).round() as i64
    })
}

fn area(ring: &[[f64; 2]]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    let twice: f64 = ring.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
    twice.abs() / 2.0
}

impl Nested {
    /// Everything was placed, and these parts were found (width and height, mm).
    #[track_caller]
    fn is(self, sizes: &[[f64; 2]]) -> Self {
        let tenths = |size: &[f64; 2]| size.map(|mm| (mm * 10.0).round() as i64);
        let mut wanted: Vec<[i64; 2]> = sizes.iter().map(tenths).collect();
        wanted.sort_unstable();
        assert_eq!((self.code, &self.sizes), (Some(0), &wanted), "{}", self.said);
        self
    }

    /// One of the lines on stderr has all these words.
    #[track_caller]
    fn says(self, words: &[&str]) -> Self {
        let mut lines = self.said.lines();
        let has = lines.any(|line| words.iter().all(|word| line.contains(word)));
        assert!(has, "{words:?} in\n{}", self.said);
        self
    }

    /// Nothing is missing, and nothing is said to be.
    #[track_caller]
    fn says_no_warning(self) -> Self {
        assert!(!self.said.contains("warning"), "{}", self.said);
        self
    }
}

/// An SVG with attributes of its root.
fn svg_of(root: &str, inside: &str) -> Nested {
    let text = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" {root}>{inside}</svg>"#
    );
    nested_as("a.svg", text.as_bytes(), &[])
}

/// An SVG whose user units are millimetres.
fn svg(inside: &str) -> Nested {
    svg_of(r#"width="200mm" height="100mm" viewBox="0 0 200 100""#, inside)
}

/// Group codes and values, separated by blanks, as lines.
fn tagged(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join("\n")
}

/// A DXF in millimetres with these tables, blocks and entities.
fn dxf_text(tables: &str, blocks: &str, entities: &str) -> String {
    let header = "0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC";
    let sections = format!(
        "{header} 0 SECTION 2 TABLES {tables} 0 ENDSEC 0 SECTION 2 BLOCKS {blocks} 0 ENDSEC \
         0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    );
    tagged(&sections)
}

fn dxf_with(text: &str, words: &[&str]) -> Nested {
    nested_as("a.dxf", text.as_bytes(), words)
}

fn dxf(entities: &str) -> Nested {
    dxf_with(&dxf_text("", "", entities), &[])
}

/// A rectangle as one polyline; `more` are tags of its own.
fn board(layer: &str, [x, y]: [f64; 2], [w, h]: [f64; 2], more: &str) -> String {
    let corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)];
    let corners = corners.map(|(x, y)| format!("10 {x} 20 {y}")).join(" ");
    format!("0 LWPOLYLINE 8 {layer} {more} 90 4 70 1 {corners} ")
}

fn line(layer: &str, a: [f64; 2], b: [f64; 2]) -> String {
    let ([ax, ay], [bx, by]) = (a, b);
    format!("0 LINE 8 {layer} 10 {ax} 20 {ay} 11 {bx} 21 {by} ")
}

/// A rectangle as four lines.
fn lines([x, y]: [f64; 2], [w, h]: [f64; 2]) -> String {
    let corners = [[x, y], [x + w, y], [x + w, y + h], [x, y + h]];
    (0..4).map(|k| line("0", corners[k], corners[(k + 1) % 4])).collect()
}

fn circle([x, y]: [f64; 2], r: f64) -> String {
    format!("0 CIRCLE 8 0 10 {x} 20 {y} 40 {r} ")
}

const BOARD: &str = r#"<rect x="10" y="10" width="80" height="30"/>"#;
const SMALL: &str = r#"<rect x="110" y="10" width="20" height="10"/>"#;

#[test]
fn a_document_type_is_no_hindrance_and_a_bomb_is_none() {
    let doctype = |declared: &str, inside: &str| {
        let text = format!(
            r#"<?xml version="1.0" encoding="UTF-8"?><!DOCTYPE svg {declared}>
            <svg xmlns="http://www.w3.org/2000/svg" width="100mm" viewBox="0 0 100 50">{inside}</svg>"#
        );
        nested_as("a.svg", text.as_bytes(), &[])
    };
    let public = r#"PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd""#;
    doctype(public, BOARD).is(&[[80.0, 30.0]]).says_no_warning();
    let entity = r#"[<!ENTITY w "80"><!ENTITY all '<rect width="&w;" height="30"/>'>]"#;
    doctype(entity, "&all;").is(&[[80.0, 30.0]]).says_no_warning();
    let tenfold =
        |k: usize| format!("<!ENTITY e{} \"{}\">", k + 1, format!("&e{k};").repeat(10));
    let bomb: String = (0..20).map(tenfold).collect();
    let bomb = doctype(&format!("[<!ENTITY e0 '<g/>'>{bomb}]"), "&e20;");
    assert_eq!(bomb.code, Some(1), "{}", bomb.said);
}

#[test]
fn a_page_without_view_box_has_96_units_to_the_inch() {
    let rect = r#"<rect x="10" y="10" width="377.953" height="188.976"/>"#;
    for root in [r#"width="210mm" height="297mm""#, r#"width="8in""#, ""] {
        svg_of(root, rect).is(&[[100.0, 50.0]]);
    }
}

#[test]
fn one_side_of_the_page_is_enough_and_its_proportions_are_kept() {
    let sides = [
        r#"width="100mm""#,
        r#"height="5cm""#,
        r#"width="100mm" height="100mm""#,
        r#"width="300mm" height="50mm" preserveAspectRatio="xMinYMax meet""#,
    ];
    for side in sides {
        svg_of(&format!(r#"{side} viewBox="0 0 100 50""#), BOARD)
            .is(&[[80.0, 30.0]])
            .says_no_warning();
    }
    let stretched = r#"width="100mm" height="100mm" preserveAspectRatio="none""#;
    svg_of(&format!(r#"{stretched} viewBox="0 0 100 50""#), BOARD).is(&[[80.0, 60.0]]);
}

#[test]
fn a_page_rounded_by_a_program_keeps_its_circles() {
    for view in ["0 0 595.28 841.89", "0 0 595.276 841.9"] {
        let root = format!(r#"width="210mm" height="297mm" viewBox="{view}""#);
        let shapes =
            r#"<rect width="10" height="5"/><circle cx="200" cy="200" r="100"/>"#;
        svg_of(&root, shapes).is(&[[3.5, 1.8], [70.6, 70.6]]).says_no_warning();
    }
}

#[test]
fn lengths_on_shapes_have_units() {
    let root = r#"width="100mm" height="50mm" viewBox="0 0 377.953 188.976""#;
    for rect in [
        r#"<rect x="10mm" y="1cm" width="80mm" height="30mm"/>"#,
        r#"<rect width="8cm" height="85.0394pt"/>"#,
        r#"<rect x="5%" width="80%" height="60%"/>"#,
        r#"<svg width="80mm" height="30mm"><rect width="100%" height="100%"/></svg>"#,
    ] {
        svg_of(root, rect).is(&[[80.0, 30.0]]).says_no_warning();
    }
}

#[test]
fn what_is_hidden_in_an_svg_is_not_cut_and_is_told() {
    for hidden in [
        r#"<g style="display:none"><rect x="110" width="60" height="30"/></g>"#,
        r#"<g display="none"><g><rect x="110" width="60" height="30"/></g></g>"#,
        r#"<rect visibility="hidden" x="110" width="60" height="30"/>"#,
        r#"<style>.off{display:none}</style><rect class="off" x="110" width="60" height="30"/>"#,
    ] {
        svg(&format!("{BOARD}{hidden}")).is(&[[80.0, 30.0]]).says(&["switched off"]);
    }
}

#[test]
fn a_drawing_inside_switch_comes_in() {
    let foreign = r#"<foreignObject requiredExtensions="x" width="1" height="1"/>"#;
    svg(&format!("{SMALL}<switch>{foreign}<g>{BOARD}</g></switch>"))
        .is(&[[20.0, 10.0], [80.0, 30.0]])
        .says_no_warning();
}

#[test]
fn copies_by_use_are_parts() {
    let rect = r#"<rect id="a" x="1" y="1" width="30" height="20"/>"#;
    let uses =
        r##"<use xlink:href="#a" x="40"/><use href="#a" transform="translate(80,0)"/>"##;
    svg(&format!("{rect}{uses}")).is(&[[30.0, 20.0]; 3]).says_no_warning();
    svg(&format!("<defs><g id='g'>{rect}</g></defs><use href='#g'/>"))
        .is(&[[30.0, 20.0]]);
    let symbol =
        r#"<symbol id="s" viewBox="0 0 10 10"><rect width="10" height="5"/></symbol>"#;
    svg(&format!("{symbol}<use href='#s' width='60' height='60'/>")).is(&[[60.0, 30.0]]);
}

#[test]
fn a_circle_scaled_unevenly_or_skewed_is_an_ellipse() {
    let square = r#"<rect x="2" y="2" width="10" height="10"/>"#;
    let pi = std::f64::consts::PI;
    for (shape, wanted) in [
        (r#"<circle cx="25" cy="25" r="10" transform="scale(2,1)"/>"#, [40.0, 20.0]),
        (
            r#"<path d="M15 25a10 10 0 0 1 20 0 10 10 0 0 1-20 0z" transform="scale(2,1)"/>"#,
            [40.0, 20.0],
        ),
        (r#"<circle cx="55" cy="25" r="10" transform="skewX(45)"/>"#, [28.284, 20.0]),
    ] {
        let read = svg(&format!("{square}{shape}")).is(&[[10.0, 10.0], wanted]);
        let ellipse = if wanted[0] > 30.0 { 200.0 * pi } else { 100.0 * pi };
        assert!((read.areas[1] / ellipse - 1.0).abs() < 2e-3, "{:?}", read.areas);
    }
}

#[test]
fn colours_from_a_style_sheet_count_as_inline_ones_do() {
    let sheet = "<style>.c{fill:none;stroke:#ff0000}.e{fill:none;stroke:#00ffff}</style>";
    let read = svg(&format!(
        r#"{sheet}<rect class="c" x="10" y="5" width="80" height="40"/>
        <rect class="e" x="20" y="15" width="30" height="10"/>"#
    ));
    let read = read.is(&[[80.0, 40.0]]).says(&["#00ffff: 1 engraved"]);
    assert!(read.holes == 0 && read.sheet.contains("ENGRAVE"));
}

#[test]
fn text_of_other_encodings_is_read() {
    let text = format!(
        "<?xml version=\"1.0\" encoding=\"iso-8859-1\"?><svg width=\"100mm\" \
         viewBox=\"0 0 100 50\"><g id=\"gr\u{fc}n\" display=\"none\">{SMALL}</g>{BOARD}</svg>"
    );
    let latin: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
    nested_as("a.svg", &latin, &[]).is(&[[80.0, 30.0]]).says(&["gr\u{fc}n"]);
    let wide = text.replace("iso-8859-1", "UTF-16");
    let wide = wide.encode_utf16().flat_map(u16::to_le_bytes);
    let wide: Vec<u8> = [255, 254].into_iter().chain(wide).collect();
    nested_as("a.svg", &wide, &[]).is(&[[80.0, 30.0]]).says(&["gr\u{fc}n"]);
}

/// A table of layers: name, colour (negative is off), flags (1 is frozen).
fn layers(list: &[(&str, i32, i32)]) -> String {
    let layer = |&(name, colour, flags): &(&str, i32, i32)| {
        format!("0 LAYER 2 {name} 70 {flags} 62 {colour} 6 CONTINUOUS ")
    };
    let all: String = list.iter().map(layer).collect();
    format!("0 TABLE 2 LAYER 70 9 {all} 0 ENDTAB")
}

#[test]
fn layers_off_or_frozen_and_invisible_lines_are_not_cut_and_are_told() {
    let visible = board("0", [0.0, 0.0], [80.0, 30.0], "");
    for (tables, layer, more) in [
        (layers(&[("0", 7, 0), ("HID", -7, 0)]), "HID", ""),
        (layers(&[("0", 7, 0), ("HID", 7, 1)]), "hid", ""),
        (layers(&[("0", 7, 0)]), "0", "60 1"),
    ] {
        let hidden = board(layer, [100.0, 0.0], [60.0, 20.0], more);
        let text = dxf_text(&tables, "", &format!("{visible}{hidden}"));
        dxf_with(&text, &[]).is(&[[80.0, 30.0]]).says(&["switched off"]);
    }
}

#[test]
fn names_of_layers_are_read_in_the_code_page_of_the_file() {
    let lines = board("0", [0.0, 0.0], [80.0, 30.0], "")
        + &board("Gr\u{fc}n", [10.0, 10.0], [9.0, 9.0], "");
    let text = dxf_text("", "", &lines)
        .replace("HEADER\n", "HEADER\n9\n$DWGCODEPAGE\n3\nANSI_1252\n");
    let bytes: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
    for bytes in [
        &bytes,
        text.as_bytes(),
        dxf_text("", "", &lines.replace('\u{fc}', "\\U+00FC")).as_bytes(),
    ] {
        let read = nested_as("a.dxf", bytes, &["--layers", "GR\u{dc}N=engrave"]);
        let read = read.is(&[[80.0, 30.0]]).says(&["Gr\u{fc}n: 1 engraved"]);
        assert_eq!(read.holes, 0);
    }
}

#[test]
fn paper_space_is_no_part() {
    let read = dxf(&(board("0", [-10.0, -10.0], [420.0, 297.0], "67 1")
        + &board("0", [0.0, 0.0], [80.0, 30.0], "")));
    read.is(&[[80.0, 30.0]]).says(&["paper space"]);
}

#[test]
fn lines_stay_where_they_are_whatever_their_extrusion_and_arcs_turn() {
    let down = "210 0 220 0 230 -1";
    // A slot seen from behind: points of arcs are in their plane, mirrored in x.
    let slot = line("0", [0.0, 0.0], [80.0, 0.0]).replace("8 0", &format!("8 0 {down}"))
        + &line("0", [0.0, 30.0], [80.0, 30.0]).replace("8 0", &format!("8 0 {down}"))
        + &format!("0 ARC 8 0 {down} 10 0 20 15 40 15 50 270 51 90 ")
        + &format!("0 ARC 8 0 {down} 10 -80 20 15 40 15 50 90 51 270 ");
    let read = dxf(&slot).is(&[[110.0, 30.0]]).says_no_warning();
    let wanted = 80.0 * 30.0 + 225.0 * std::f64::consts::PI;
    assert!((read.areas[0] - wanted).abs() < 1.0, "{:?}", read.areas);
}

#[test]
fn what_stands_upright_or_leans_is_told_and_not_laid_flat() {
    let flat = board("0", [0.0, 0.0], [80.0, 30.0], "");
    for direction in ["210 0 220 -1 230 0", "210 0.6 220 0 230 0.8"] {
        let leaning = board("0", [100.0, 0.0], [40.0, 20.0], direction);
        dxf(&format!("{flat}{leaning}")).is(&[[80.0, 30.0]]).says(&["tilted"]);
    }
}

#[test]
fn blocks_are_parts_wherever_they_are_inserted() {
    let plate = board("0", [0.0, 0.0], [40.0, 20.0], "") + &circle([10.0, 10.0], 4.0);
    let block = |name: &str, inside: &str| {
        format!("0 BLOCK 2 {name} 10 0 20 0 {inside} 0 ENDBLK ")
    };
    let blocks = block("A", &plate) + &block("B", "0 INSERT 2 A 10 5 20 5 50 30 ");
    for insert in [
        "0 INSERT 2 A 10 0 20 0 0 INSERT 2 A 10 100 20 0 41 -1 ",
        "0 INSERT 2 a 10 0 20 0 70 2 44 60 ",
        "0 INSERT 2 B 10 0 20 0 50 -30 0 INSERT 2 B 10 0 20 90 50 60 ",
    ] {
        let read = dxf_with(&dxf_text("", &blocks, insert), &["--rotations", "none"]);
        let turned = insert.contains("50 60");
        let second = if turned { [20.0, 40.0] } else { [40.0, 20.0] };
        let read = read.is(&[[40.0, 20.0], second]).says_no_warning();
        assert_eq!(read.holes, 2);
    }
    let gone = dxf("0 INSERT 2 GONE 10 0 20 0 ");
    assert_eq!(gone.code, Some(1));
    gone.says(&["no closed line", "INSERT"]);
}

#[test]
fn weighted_splines_and_splines_through_points_come_in() {
    let small = board("0", [0.0, 0.0], [20.0, 10.0], "");
    let corners =
        [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let points: String = corners
        .iter()
        .map(|(x, y)| format!("10 {} 20 {} ", 60 + 20 * x, 20 * y))
        .collect();
    let weights: String = (0..9)
        .map(|k| if k % 2 == 0 { "41 1 " } else { "41 0.7071067811865476 " })
        .collect();
    let knots = "40 0 40 0 40 0 40 1 40 1 40 2 40 2 40 3 40 3 40 4 40 4 40 4";
    let nurbs = format!("0 SPLINE 8 0 70 4 71 2 72 12 73 9 {knots} {weights} {points} ");
    let read = dxf(&(small.clone() + &nurbs))
        .is(&[[20.0, 10.0], [40.0, 40.0]])
        .says_no_warning();
    assert!((read.areas[1] / (400.0 * std::f64::consts::PI) - 1.0).abs() < 2e-3);
    let fit: String = [(80, 0), (60, 20), (40, 0), (60, -20), (80, 0)]
        .map(|(x, y)| format!("11 {x} 21 {y} "))
        .concat();
    let through = dxf(&(small + "0 SPLINE 8 0 70 1 71 3 74 5 " + &fit)).says_no_warning();
    assert_eq!(through.sizes.len(), 2);
    assert!((through.areas[1] / (400.0 * std::f64::consts::PI) - 1.0).abs() < 0.1);
}

#[test]
fn every_unit_code_is_known_and_can_be_overruled() {
    for (code, mm) in [
        (1, 25.4),
        (2, 304.8),
        (5, 10.0),
        (9, 0.0254),
        (10, 914.4),
        (13, 1e-3),
        (14, 100.0),
    ] {
        let drawn = board("0", [0.0, 0.0], [80.0 / mm, 30.0 / mm], "");
        let text = dxf_text("", "", &drawn)
            .replace("$INSUNITS\n70\n4", &format!("$INSUNITS\n70\n{code}"));
        dxf_with(&text, &[]).is(&[[80.0, 30.0]]).says_no_warning();
    }
    let text = dxf_text("", "", &board("0", [0.0, 0.0], [8.0, 3.0], ""));
    dxf_with(&text, &["--units", "cm"]).is(&[[80.0, 30.0]]);
    let unsaid = text.replace("$INSUNITS\n70\n4", "$INSUNITS\n70\n0");
    dxf_with(&unsaid, &[])
        .is(&[[8.0, 3.0]])
        .says(&["does not say its unit", "8.0 x 3.0"]);
}

#[test]
fn nothing_counts_after_the_end_of_the_file() {
    let text = dxf_text("", "", &board("0", [0.0, 0.0], [80.0, 30.0], ""));
    for tail in ["\n\n\n", "\r\n\x1a", "\nspam\neggs\n", "\n0\nSECTION\n"] {
        dxf_with(&format!("{text}{tail}"), &[]).is(&[[80.0, 30.0]]).says_no_warning();
    }
}

#[test]
fn an_outline_drawn_twice_is_cut_once_and_told() {
    let once = board("0", [0.0, 0.0], [80.0, 30.0], "");
    let again = board("OTHER", [0.004, 0.0], [80.0, 30.0], "");
    for twice in [
        once.clone() + &again,
        once.clone() + &lines([0.0, 0.0], [80.0, 30.0]),
        lines([0.0, 0.0], [80.0, 30.0]).repeat(2),
    ] {
        let read = dxf(&twice).is(&[[80.0, 30.0]]).says(&["lie on another one"]);
        assert_eq!(read.holes, 0);
    }
}

#[test]
fn a_line_over_a_line_is_told() {
    let drawn = lines([0.0, 0.0], [80.0, 30.0]);
    dxf(&(drawn.clone() + &line("0", [20.0, 0.0], [60.0, 0.0])))
        .is(&[[80.0, 30.0]])
        .says(&["lie on another one"]);
    dxf(&(drawn
        + &line("CUT", [20.0, 5.0], [60.0, 5.0])
        + &line("CUT", [70.0, 5.0], [30.0, 5.0])))
    .is(&[[80.0, 30.0]])
    .says(&["run over"]);
}

#[test]
fn the_width_of_a_gap_is_told_and_closes_on_request() {
    let small = board("0", [100.0, 0.0], [20.0, 10.0], "");
    let open = "0 LWPOLYLINE 8 0 90 5 70 0 10 0 20 0 10 80 20 0 10 80 20 30 10 0 20 30 10 0 20 0.03 ";
    let text = dxf_text("", "", &format!("{small}{open}"));
    dxf_with(&text, &[]).is(&[[20.0, 10.0]]).says(&["gap", "0.030 mm"]);
    dxf_with(&text, &["--join", "0.1"])
        .is(&[[20.0, 10.0], [80.0, 30.0]])
        .says_no_warning();
}

#[test]
fn outlines_that_share_an_edge_are_both_parts_or_told() {
    let shared = lines([0.0, 0.0], [80.0, 30.0])
        + &line("0", [80.0, 0.0], [120.0, 0.0])
        + &line("0", [120.0, 0.0], [120.0, 30.0])
        + &line("0", [120.0, 30.0], [80.0, 30.0]);
    dxf(&shared).is(&[[80.0, 30.0]]).says(&["share an edge"]);
}

#[test]
fn a_hole_that_touches_its_outline_is_told() {
    dxf(&(board("0", [0.0, 0.0], [10.0, 10.0], "") + &circle([5.0, 5.0], 5.0)))
        .says(&["touch"]);
    dxf(&(board("0", [0.0, 0.0], [80.0, 30.0], "")
        + &board("0", [0.0, 10.0], [9.0, 9.0], "")))
    .says(&["touch"]);
}

#[test]
fn a_part_is_as_large_as_it_is_wherever_it_was_drawn() {
    for far in [1e5, 1_234_567.0, 4.5e7] {
        let read = dxf(&(board("0", [far, -far], [80.0, 30.0], "")
            + &circle([far + 40.0, 15.0 - far], 5.0)));
        assert_eq!(read.is(&[[80.0, 30.0]]).says_no_warning().holes, 1);
    }
}

#[test]
fn a_number_that_is_none_is_an_error_with_its_line() {
    for wrong in ["5,5", "5.5mm", "1.2.3"] {
        let text = dxf_text(
            "",
            "",
            &(board("0", [0.0, 0.0], [80.0, 30.0], "")
                + &circle([40.0, 15.0], 5.5).replace("5.5", wrong)),
        );
        let at = text.lines().position(|line| line == wrong).unwrap() + 1;
        let read = dxf_with(&text, &[]);
        assert_eq!(read.code, Some(1));
        read.says(&[&format!("line {at}"), wrong]);
    }
}

#[test]
fn open_lines_on_cut_layers_are_cut_and_purposes_are_told() {
    let plate = board("Cut", [0.0, 0.0], [80.0, 30.0], "");
    let slits: String =
        [30.0, 34.0, 38.0].map(|x| line("Cut", [x, 5.0], [x, 25.0])).concat();
    let text = dxf_text("", "", &(plate.clone() + &slits));
    let read = dxf_with(&text, &[]).is(&[[80.0, 30.0]]);
    let other = dxf_text("", "", &(plate + &slits.replace("Cut", "Hinge")));
    let engraved = dxf_with(&other, &[]).says(&["Hinge: 3 engraved"]);
    let cut = dxf_with(&other, &["--layers", "hinge=cut"]).says(&["Hinge: 3 cut"]);
    let inner = |read: &Nested| read.sheet.matches("CUT_INNER").count();
    assert_eq!(inner(&read), inner(&cut));
    assert!(inner(&cut) >= inner(&engraved) + 3);
}

#[test]
fn a_drawing_without_a_cut_says_what_its_lines_are_taken_for() {
    let green = svg(&BOARD.replace("/>", r##" stroke="#0f0"/>"##));
    assert_eq!(green.code, Some(1));
    green.says(&["no closed line", "#00ff00: 1 scored"]);
}

/// A DXF as tagged text, in binary.
fn binary(text: &str) -> Vec<u8> {
    let mut bytes = b"AutoCAD Binary DXF\r\n\x1a\0".to_vec();
    let lines: Vec<&str> = text.lines().collect();
    for pair in lines.chunks_exact(2) {
        let code: i16 = pair[0].parse().unwrap();
        bytes.extend(code.to_le_bytes());
        match code {
            10..=59 | 210..=239 => {
                bytes.extend(pair[1].parse::<f64>().unwrap().to_le_bytes());
            }
            60..=79 => bytes.extend(pair[1].parse::<i16>().unwrap().to_le_bytes()),
            90..=99 => bytes.extend(pair[1].parse::<i32>().unwrap().to_le_bytes()),
            _ => bytes.extend(pair[1].bytes().chain([0])),
        }
    }
    bytes
}

#[test]
fn a_binary_dxf_comes_in_and_one_cut_off_is_told() {
    let text = dxf_text(
        "",
        "",
        &(board("0", [0.0, 0.0], [80.0, 30.0], "") + &circle([40.0, 15.0], 5.0)),
    );
    let bytes = binary(&text);
    let read = nested_as("a.dxf", &bytes, &[]).is(&[[80.0, 30.0]]).says_no_warning();
    assert_eq!(read.holes, 1);
    let cut_off = nested_as("a.dxf", &bytes[..bytes.len() - 30], &[]);
    assert_eq!(cut_off.code, Some(1));
    cut_off.says(&["binary DXF"]);
}
