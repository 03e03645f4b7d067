//! The nester on parts that nobody would draw: each is placed or refused by its name, and
//! what is placed never overlaps.

use finwright::geometry::{Point2, trig};
use finwright::nest::{
    Effort, Layout, LayoutFault, NestedSheet, Placement, Remnant, Rotations, Shape,
    Stock, check, outline_fault, search, stock_fault, strip,
};
use finwright::watch::Watch;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::Path;

/// Numbers in 0 to 1, the same on every run (SplitMix64).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn up_to(&mut self, count: usize) -> usize {
        (self.roll() * count as f64) as usize
    }
}

fn ring(centre: [f64; 2], radius: f64, corners: usize) -> Vec<Point2> {
    let corner = |k: usize| {
        let turn = TAU * k as f64 / corners as f64;
        Point2::new(
            centre[0] + radius * trig::cos(turn),
            centre[1] + radius * trig::sin(turn),
        )
    };
    (0..corners).map(corner).collect()
}

/// A needle, a comb, a star, a ring, a dented box; sometimes spoilt.
fn part(k: usize, dice: &mut Dice) -> Shape {
    let size = 5.0 + 120.0 * dice.roll();
    let mut holes = Vec::new();
    let mut outline = match dice.up_to(5) {
        0 => vec![
            Point2::origin(),
            Point2::new(size, 0.0),
            Point2::new(size, 1e-3 + 0.1 * dice.roll()),
        ],
        1 => {
            let teeth = 3 + dice.up_to(6);
            let pitch = size / teeth as f64;
            let tooth = |k: usize| {
                let x = pitch * k as f64;
                [[x, 20.0], [x, 5.0], [x + pitch / 2.0, 5.0], [x + pitch / 2.0, 20.0]]
            };
            let top = (0..teeth).rev().flat_map(|k| tooth(k).into_iter().rev());
            let base = [[0.0, 0.0], [size - pitch / 2.0, 0.0]];
            base.into_iter().chain(top).map(Point2::from).collect()
        }
        2 => {
            let points = 2 * (4 + dice.up_to(8));
            let mut star = ring([0.0; 2], size / 2.0, points);
            star.iter_mut().step_by(2).for_each(|p| *p *= 0.3);
            star
        }
        3 => {
            holes.push(ring([0.0; 2], 0.3 * size, 12));
            ring([0.0; 2], size / 2.0, 24)
        }
        _ => [[0.0, 0.0], [size, 0.0], [size / 2.0, 2.0], [size, 30.0], [0.0, 30.0]]
            .map(Point2::from)
            .to_vec(),
    };
    match dice.up_to(12) {
        0 => outline.push(outline[0]),
        1 => outline.insert(1, outline[0]),
        2 => outline.swap(0, 1),
        3 => outline.iter_mut().for_each(|p| *p *= 1e7),
        4 => outline[0].x = f64::NAN,
        5 => outline.truncate(2),
        6 => holes.push(ring([0.0; 2], 0.3 * size, 12)),
        7 => outline.iter_mut().for_each(|p| p.y = 0.0),
        8 => outline.iter_mut().for_each(|p| p.x += 9e5),
        _ => {}
    }
    let rotations = match dice.up_to(3) {
        0 => Rotations::Only(vec![0.0, TAU / 4.0]),
        _ => Rotations::Free,
    };
    Shape { name: format!("P{k}"), outline, holes, rotations, priority: 0 }
}

#[test]
fn odd_parts_are_placed_or_refused_and_never_overlap() {
    let stock = [
        Stock { count: Some(3), ..Stock::new([300.0, 200.0], 4.0, 1.5) },
        Stock::new([160.0, 90.0], 4.0, 1.5),
    ];
    for seed in 0..40 {
        let mut dice = Dice(seed);
        let count = 1 + dice.up_to(30);
        let parts: Vec<Shape> = (0..count).map(|k| part(k, &mut dice)).collect();
        let (good, bad): (Vec<Shape>, Vec<Shape>) =
            parts.into_iter().partition(|part| outline_fault(part).is_none());
        for part in &bad {
            let why = outline_fault(part).expect("it was refused").to_string();
            assert!(why.contains(&part.name), "{why}");
        }
        let effort = Effort { trials: 3, seed };
        let found = search(&good, &stock, &effort, &mut ()).expect("a layout");
        assert_eq!(check(&found.layout, &good, &stock), [], "seed {seed}");
        let on = found.layout.sheets.iter().flat_map(|sheet| &sheet.placements);
        let on: Vec<usize> = on.map(|placement| placement.shape).collect();
        let once: BTreeSet<usize> = on.iter().copied().collect();
        assert_eq!(on.len(), once.len(), "seed {seed}: a part was placed twice");
        assert_eq!(on.len() + found.unplaced.len(), good.len(), "seed {seed}");
        let again = search(&good, &stock, &effort, &mut ()).expect("a layout");
        assert_eq!(found, again, "seed {seed}");
    }
}

/// One part too large for every sheet keeps nobody from searching for the rest.
#[test]
fn what_fits_no_sheet_is_named_and_the_rest_is_nested_densely() {
    let board = |name: String, width: f64| Shape {
        name,
        outline: [[0.0, 0.0], [width, 0.0], [width, 20.0], [0.0, 20.0]]
            .map(Point2::from)
            .to_vec(),
        holes: Vec::new(),
        rotations: Rotations::Free,
        priority: 0,
    };
    let stock = [Stock::new([200.0, 100.0], 2.0, 1.0)];
    let mut parts: Vec<Shape> = (0..8).map(|k| board(format!("B{k}"), 90.0)).collect();
    parts.insert(3, board("long".into(), 900.0));
    let effort = Effort { trials: 20, seed: 0 };
    let found = search(&parts, &stock, &effort, &mut ()).expect("a layout");
    assert!(found.unplaced[0].to_string().contains("long"));
    assert_eq!(found.layout.sheets.len(), 1);
    let on = &found.layout.sheets[0].placements;
    assert_eq!((on.len(), on.iter().any(|p| p.shape == 3)), (8, false));
    assert!(found.trials > 1, "there was no search");
}

/// Equal rectangles: the strip cannot be shorter than their area allows, and the search
/// comes close.
#[test]
fn a_strip_of_rectangles_is_nearly_full() {
    let board = |k: usize| Shape {
        name: format!("B{k}"),
        outline: [[0.0, 0.0], [40.0, 0.0], [40.0, 25.0], [0.0, 25.0]]
            .map(Point2::from)
            .to_vec(),
        holes: Vec::new(),
        rotations: Rotations::Only(vec![0.0, TAU / 4.0]),
        priority: 0,
    };
    let parts: Vec<Shape> = (0..16).map(board).collect();
    let sheet = Stock::new([1.0, 101.0], 0.0, 0.0);
    let found =
        strip(&parts, &sheet, &Effort { trials: 40, seed: 1 }, &mut ()).expect("a strip");
    assert!((160.0..176.0).contains(&found.length), "{}", found.length);
}

fn board(name: &str, [width, height]: [f64; 2]) -> Shape {
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    Shape {
        name: name.into(),
        outline: corners.map(Point2::from).to_vec(),
        holes: Vec::new(),
        rotations: Rotations::Free,
        priority: 0,
    }
}

/// An L with a hole in its foot.
fn remnant(margin: f64) -> Stock {
    let corners = [[0.0, 0.0], [300.0, 0.0], [300.0, 120.0], [120.0, 120.0]];
    let corners = corners.into_iter().chain([[120.0, 260.0], [0.0, 260.0]]);
    let outline = corners.map(Point2::from).collect();
    let mut hole = ring([60.0, 60.0], 25.0, 16);
    hole.reverse();
    let remnant = Some(Remnant { outline, holes: vec![hole] });
    let cost = 0.0;
    Stock { remnant, cost, count: Some(1), ..Stock::new([300.0, 260.0], margin, 2.0) }
}

fn on_sheet(x: f64, y: f64) -> Layout {
    let placements = vec![Placement { shape: 0, angle: 0.0, x, y }];
    Layout { sheets: vec![NestedSheet { stock: 0, placements }] }
}

/// Edges of a remnant count as the sheet's: the margin is kept from all of them, and a part
/// beside it, across it or around its hole is found.
#[test]
fn the_check_sees_every_way_to_leave_a_remnant() {
    let (stock, part) = ([remnant(4.0)], [board("B", [40.0, 20.0])]);
    let faults = |x, y| check(&on_sheet(x, y), &part, &stock);
    assert_eq!(faults(150.0, 50.0), []);
    assert_eq!(faults(4.0, 236.0), []);
    assert_eq!(faults(76.0, 230.0), []);
    assert!(matches!(faults(77.0, 230.0)[..], [LayoutFault::InMargin { .. }, ..]));
    assert!(matches!(faults(200.0, 97.0)[..], [LayoutFault::InMargin { .. }, ..]));
    assert!(matches!(faults(200.0, 110.0)[..], [LayoutFault::OverEdge { .. }, ..]));
    assert!(matches!(faults(200.0, 180.0)[..], [LayoutFault::OverEdge { .. }, ..]));
    assert!(matches!(faults(50.0, 50.0)[..], [LayoutFault::OverEdge { .. }, ..]));
    assert!(matches!(faults(88.0, 50.0)[..], [LayoutFault::InMargin { .. }, ..]));
    let large = [board("L", [90.0, 90.0])];
    let around = check(&on_sheet(15.0, 15.0), &large, &stock);
    assert!(matches!(around[..], [LayoutFault::OverEdge { .. }, ..]), "{around:?}");
}

/// Remnants cost nothing and are filled first; what lies on a sheet stays there to the last
/// digit; what the rest costs is as little as can be.
#[test]
fn remnants_locked_parts_and_prices_count() {
    let mut parts: Vec<Shape> =
        (0..30).map(|k| board(&format!("B{k}"), [70.0, 30.0])).collect();
    parts.extend((0..6).map(|k| board(&format!("C{k}"), [25.0, 25.0])));
    let locked = Placement { shape: 3, angle: 0.5, x: 60.0, y: 40.0 };
    let stock = [
        Stock { cost: 9.0, ..Stock::new([400.0, 300.0], 5.0, 2.0) },
        remnant(4.0),
        Stock { locked: vec![locked], ..Stock::new([220.0, 160.0], 5.0, 2.0) },
        Stock { cost: 1.0, ..Stock::new([210.0, 140.0], 5.0, 2.0) },
    ];
    for trials in [1, 30] {
        let effort = Effort { trials, seed: 4 };
        let found = search(&parts, &stock, &effort, &mut ()).expect("a layout");
        assert_eq!(
            (check(&found.layout, &parts, &stock), found.unplaced),
            (vec![], vec![])
        );
        let on = |kind| found.layout.sheets.iter().filter(move |s| s.stock == kind);
        assert!(on(2).all(|sheet| sheet.placements.contains(&locked)));
        assert_eq!((on(1).count(), on(2).count()), (1, 1));
        if trials > 1 {
            // The two odd sheets and one small one hold them.
            assert_eq!((on(0).count(), on(3).count()), (0, 1));
        }
    }
    let beside = Stock {
        locked: vec![Placement { x: 200.0, ..locked }],
        ..Stock::new([220.0, 160.0], 5.0, 2.0)
    };
    let refusal = stock_fault(&parts, &[beside]).expect("it reaches over the edge");
    assert!(refusal.to_string().contains("B3 reaches into the margin"), "{refusal}");
}

/// When the stock does not do, the important parts are on it.
#[test]
fn parts_of_higher_priority_come_first() {
    let mut parts: Vec<Shape> =
        (0..8).map(|k| board(&format!("large{k}"), [90.0, 45.0])).collect();
    parts.extend((0..6).map(|k| board(&format!("small{k}"), [40.0, 30.0])));
    parts[8..].iter_mut().for_each(|part| part.priority = 1);
    let stock = [Stock { count: Some(1), ..Stock::new([200.0, 100.0], 2.0, 1.0) }];
    for trials in [1, 40] {
        let effort = Effort { trials, seed: 0 };
        let found = search(&parts, &stock, &effort, &mut ()).expect("a layout");
        let said: Vec<String> = found.unplaced.iter().map(ToString::to_string).collect();
        assert!(said.iter().all(|why| why.contains("large")), "{said:?}");
        assert!((4..8).contains(&said.len()), "{said:?}");
    }
}

/// Has enough after some units of work.
struct Units(usize, usize);

impl Watch for Units {
    fn progress(&mut self, _: &'static str, done: usize, _: usize) {
        self.1 = done;
    }

    fn stopped(&self) -> bool {
        false
    }

    fn enough(&self) -> bool {
        self.1 >= self.0
    }
}

/// However a search ends, its units of work lead to the same layout again.
#[test]
fn a_search_cut_short_is_repeated_by_its_units() {
    let mut dice = Dice(7);
    let parts: Vec<Shape> = (0..30).map(|k| part(k, &mut dice)).collect();
    let parts: Vec<Shape> =
        parts.into_iter().filter(|p| outline_fault(p).is_none()).collect();
    let stock = [Stock::new([200.0, 150.0], 3.0, 1.0)];
    let forever = Effort { trials: u32::MAX, seed: 3 };
    let cut =
        |units| search(&parts, &stock, &forever, &mut Units(units, 0)).expect("it is");
    for units in [2, 9, 40] {
        let short = cut(units);
        // It may end by itself, when nothing is left to try.
        assert!((2..=units).contains(&(short.trials as usize)));
        assert_eq!(short, cut(short.trials as usize));
        // What is found later is another layout or the same, and no worse.
        let sheets = |units| cut(units).layout.sheets.len();
        assert!(sheets(60) <= sheets(units));
    }
}

fn nested(place: &Path, file: &str, words: &[&str]) -> std::process::Command {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_finwright"));
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(file);
    command.arg("nest").arg(file).args(words).current_dir(place);
    command
}

fn layout_json(place: &Path, folder: &str) -> String {
    let path = place.join(folder).join("layout.json");
    std::fs::read_to_string(path).expect("it was written")
}

/// The example of docs/nesting.md: a run by the clock says which `--work` repeats it, to the
/// byte; `--check` finds nothing in it, and something once a part is moved.
#[test]
fn the_printed_units_repeat_a_run_by_the_clock() {
    let place = tempfile::tempdir().expect("there is room");
    let run = |words: &[&str]| {
        nested(place.path(), "remnants.json", words).output().expect("it was built")
    };
    let timed = run(&["--time-limit", "1", "--seed", "5", "-o", "a"]);
    assert_eq!(timed.status.code(), Some(0));
    let said = String::from_utf8(timed.stderr).expect("text");
    let units = said.split("--work ").nth(1).and_then(|rest| rest.split(' ').next());
    let units = units.expect("the units are printed");
    let again = run(&["--work", units, "--seed", "5", "-o", "b"]);
    assert_eq!(again.status.code(), Some(0));
    let layout = layout_json(place.path(), "a");
    assert_eq!(layout, layout_json(place.path(), "b"));
    let check = |text: &str| {
        let path = place.path().join("moved.json");
        std::fs::write(&path, text).expect("it can be written");
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_finwright"));
        command.args(["nest", "--check"]).arg(&path).status().expect("it runs").code()
    };
    assert_eq!(check(&layout), Some(0));
    let mut moved: serde_json::Value = serde_json::from_str(&layout).expect("JSON");
    let sheets = moved["sheets"].as_array_mut().expect("a list");
    let remnant = sheets.iter_mut().find(|sheet| !sheet["outline"].is_null());
    let part = &mut remnant.expect("the remnant is used")["placements"][0];
    (part["x"], part["y"]) = (300.0.into(), 250.0.into());
    assert_eq!(check(&moved.to_string()), Some(3));
}

/// On a remnant there is nothing to press or to exchange: the search ends by itself, however
/// long it may go on.
#[test]
fn a_search_with_nothing_to_try_ends() {
    let place = tempfile::tempdir().expect("there is room");
    let corners =
        [(0.0, 0.0), (200.0, 0.0), (200.0, 100.0), (100.0, 200.0), (0.0, 200.0)];
    let edge = corners.map(|(x, y)| [x, y]);
    let parts = serde_json::json!({
        "format": "finwright-parts", "version": 1, "name": "one", "spacing": 2,
        "sheets": [{"outline": edge, "margin": 4, "count": 1, "cost": 0}],
        "parts": [{"id": "bar", "quantity": 1, "outline": [[0, 0], [60, 0], [60, 20], [0, 20]]}],
    });
    let file = place.path().join("one.json");
    std::fs::write(&file, parts.to_string()).expect("it can be written");
    let file = file.to_str().expect("text");
    let words = ["--time-limit", "1000000", "-o", "a"];
    let ran = nested(place.path(), file, &words).output().expect("it runs");
    assert_eq!(ran.status.code(), Some(0));
    assert!(layout_json(place.path(), "a").contains("\"bar\""));
}

/// Ctrl-C: the best so far is written, and the exit code tells.
#[cfg(unix)]
#[test]
fn an_interrupted_nest_writes_the_best_so_far() {
    let place = tempfile::tempdir().expect("there is room");
    let words = ["--time-limit", "100", "-q", "-o", "a"];
    let mut command = nested(place.path(), "parts.json", &words);
    let mut child = command.spawn().expect("it was built");
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let id = child.id().to_string();
    let kill = std::process::Command::new("kill").args(["-INT", &id]).status();
    assert!(kill.expect("kill is there").success());
    assert_eq!(child.wait().expect("it ends").code(), Some(4));
    assert!(layout_json(place.path(), "a").contains("finwright-layout"));
}

/// A box by boxes.py, whose lines loop at inner corners: all sides are placed, and the
/// picture asked for is there, with the sheet in it.
#[test]
fn a_drawing_with_loops_is_nested_and_a_snapshot_kept() {
    let place = tempfile::tempdir().expect("there is room");
    let words =
        ["--sheet", "200x120", "--work", "4", "--snapshot", "best.png", "-o", "box"];
    let ran = nested(place.path(), "closed_box.svg", &words).output().expect("it runs");
    let said = String::from_utf8_lossy(&ran.stderr);
    assert_eq!(ran.status.code(), Some(0), "{said}");
    assert!(!said.contains("warning"), "{said}");
    let layout: serde_json::Value =
        serde_json::from_str(&layout_json(place.path(), "box")).expect("JSON");
    let sheets = layout["sheets"].as_array().expect("a list");
    let count =
        |sheet: &serde_json::Value| sheet["placements"].as_array().map_or(0, Vec::len);
    assert_eq!(sheets.iter().map(count).sum::<usize>(), 6);
    let picture = std::fs::read(place.path().join("best.png")).expect("it was written");
    let picture = tiny_skia::Pixmap::decode_png(&picture).expect("a picture");
    assert!(picture.width() >= 200 && picture.height() >= 120, "{said}");
}

/// A drawing by Inkscape 1.2 with round corners, a circle, an ellipse, cubics and an engraved
/// line, and the DXF it makes of it (lines and splines): the same parts, by closed formulas.
#[test]
fn what_inkscape_draws_comes_in_whole() {
    let place = tempfile::tempdir().expect("there is room");
    for file in ["inkscape.svg", "inkscape.dxf"] {
        let words = ["--sheet", "300x200", "--work", "1", "-o", file];
        let ran = nested(place.path(), file, &words).output().expect("it runs");
        let said = String::from_utf8_lossy(&ran.stderr);
        assert_eq!(ran.status.code(), Some(0), "{said}");
        assert!(!said.contains("warning") && said.contains("3 parts"), "{said}");
        let layout: serde_json::Value =
            serde_json::from_str(&layout_json(place.path(), file)).expect("JSON");
        let pi = std::f64::consts::PI;
        let plate = 60.0 * 40.0 - (4.0 - pi) * 36.0 - pi * 64.0;
        let area = plate + pi * 450.0 + 70.0 * 25.0;
        let filled = layout["utilisation"].as_f64().expect("a number") * 300.0 * 200.0;
        assert!((filled / area - 1.0).abs() < 1e-3, "{file}: {filled}, {area}");
    }
}
