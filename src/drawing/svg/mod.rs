//! SVG as our exporter and drawing programs write it, at the size that a browser shows.
//!
//! Groups, nested drawings, copies (`use`, `symbol`), `switch` and style sheets are followed;
//! what is switched off (`display`, `visibility`) is counted, not drawn. Sizes by CSS: 96
//! user units to the inch where nothing else is said.

mod shape;
mod style;
mod viewport;

use crate::drawing::transform::transformed;
use crate::drawing::{Curve, Drawing, DrawingError, Pen, Reading, Source};
use crate::drawing::{chain, is_cut, layer_coloured, layer_named, text};
use crate::tolerance::{ARC_SAGITTA_MM, JOINED_MM};
use nalgebra::{Matrix3, Vector2};
use roxmltree::{Document, Node, ParsingOptions};
use simplecss::StyleSheet;
use std::collections::BTreeMap;
use style::Style;
use svgtypes::Transform;

/// Reads the lines of an SVG file, in millimetres with y upward.
///
/// # Errors
/// [`DrawingError`] if the bytes are no SVG.
/// ```
/// use finwright::drawing::{Reading, read_svg};
///
/// let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="50mm" viewBox="0 0 100 50">
///                <rect x="10" y="10" width="80" height="30" stroke="red"/>
///              </svg>"#;
/// let drawing = read_svg(svg.as_bytes(), &Reading::of(&[])).unwrap();
/// assert_eq!(drawing.curves[0].contour().signed_area().abs(), 2400.0);
/// ```
pub fn read_svg(bytes: &[u8], reading: &Reading) -> Result<Drawing, DrawingError> {
    let text = text::xml(bytes);
    let other = |message: String| DrawingError::Other { message };
    // Entities that name each other are counted by the parser, ten deep at most.
    let options = ParsingOptions {
        allow_dtd: true,
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let text = text.trim_start_matches(['\u{feff}', ' ', '\t', '\r', '\n']);
    let document = Document::parse_with_options(text, options)
        .map_err(|error| other(error.to_string()))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(other(format!("its root is <{}>", root.tag_name().name())));
    }
    let page = viewport::page(root, reading);
    let ids = document.descendants().filter_map(|n| Some((n.attribute("id")?, n)));
    let mut reader = Reader {
        reading,
        drawing: Drawing { says_unit: page.says_unit, ..Drawing::default() },
        sheet: style::sheet(&document),
        ids: ids.collect(),
        copied: 0,
    };
    let place = Place {
        matrix: page.matrix,
        viewport: page.viewport,
        layer: "",
        style: Style::default().within(&root, &reader.sheet),
        is_copy: false,
        depth: 0,
    };
    for child in root.children() {
        reader.walk(child, &place);
    }
    Ok(chain::joined(reader.drawing, JOINED_MM, |c| is_cut(c.layer).then_some(c.layer)))
}

/// Groups in groups are followed so far; no drawing program goes as deep.
const DEEPEST: usize = 100;
/// Elements in one file, at most.
const MOST_NODES: u32 = 10_000_000;
/// Elements and corners drawn by `use`, at most: copies of copies grow without bound.
const MOST_COPIED: usize = 4_000_000;

struct Reader<'a, 'input> {
    reading: &'a Reading<'a>,
    drawing: Drawing,
    sheet: StyleSheet<'a>,
    ids: BTreeMap<&'a str, Node<'a, 'input>>,
    /// Elements and corners drawn by `use` so far.
    copied: usize,
}

/// Where an element stands, and what it takes over from those around it.
#[derive(Clone)]
struct Place {
    /// From its coordinates to millimetres.
    matrix: Matrix3<f64>,
    /// Width and height that percentages are of, in its coordinates.
    viewport: [f64; 2],
    layer: &'static str,
    style: Style,
    is_copy: bool,
    depth: usize,
}

impl<'a, 'input> Reader<'a, 'input> {
    fn walk(&mut self, node: Node<'a, 'input>, outer: &Place) {
        if !node.is_element() {
            return;
        }
        let name = node.tag_name().name();
        self.copied += usize::from(outer.is_copy);
        if outer.depth > DEEPEST || self.copied > MOST_COPIED {
            return self.unread(format!("<{name}> too deep or copied too often"), "");
        }
        let mut place = self.place(node, outer);
        if place.style.is_switched_off {
            return self.hide(node, &place);
        }
        match name {
            "g" | "a" => self.children(node, &place),
            "svg" => {
                place.enter(viewport::nested(node, None, place.viewport, self.reading));
                self.children(node, &place);
            }
            "switch" => {
                let chosen = node.children().find(|n| n.is_element() && is_for_us(n));
                if let Some(chosen) = chosen {
                    self.walk(chosen, &place);
                }
            }
            "use" => self.copy(node, place),
            "text" | "image" | "foreignObject" => {
                self.unread(format!("<{name}>"), place.layer);
            }
            _ if shape::is_shape(name) => self.shape(node, &place),
            _ => {}
        }
    }

    fn children(&mut self, node: Node<'a, 'input>, place: &Place) {
        for child in node.children() {
            self.walk(child, place);
        }
    }

    fn place(&self, node: Node, outer: &Place) -> Place {
        let own = node.attribute("transform").and_then(|text| text.parse().ok());
        let style = outer.style.within(&node, &self.sheet);
        let known = self.reading.known;
        let mut names = node.attributes().filter(|a| ["id", "label"].contains(&a.name()));
        let named = names.find_map(|attribute| layer_named(known, attribute.value()));
        let layer = named.or(style.own_colour.and_then(|rgb| layer_coloured(known, rgb)));
        Place {
            matrix: own.map_or(outer.matrix, |own| outer.matrix * matrix(own)),
            layer: layer.unwrap_or(outer.layer),
            style,
            depth: outer.depth + 1,
            ..*outer
        }
    }

    /// Draws what a `use` refers to (SVG 1.1 §5.6).
    fn copy(&mut self, node: Node<'a, 'input>, mut place: Place) {
        let link = node.attributes().find(|attribute| attribute.name() == "href");
        let id = link.and_then(|link| link.value().trim().strip_prefix('#'));
        let Some(&target) = id.and_then(|id| self.ids.get(id)) else {
            return self.unread("<use> of another file".to_owned(), place.layer);
        };
        let length =
            |name, axis| viewport::length(node, name, place.viewport[axis], self.reading);
        let [x, y] = [length("x", 0), length("y", 1)].map(|mm| mm.unwrap_or(0.0));
        place.matrix *= Matrix3::new_translation(&Vector2::new(x, y));
        place.is_copy = true;
        if target.tag_name().name() != "symbol" {
            return self.walk(target, &place);
        }
        let mut inner = self.place(target, &place);
        if inner.style.is_switched_off {
            return self.hide(target, &inner);
        }
        inner.enter(viewport::nested(target, Some(node), place.viewport, self.reading));
        self.children(target, &inner);
    }

    fn shape(&mut self, node: Node, place: &Place) {
        if place.style.is_hidden {
            return self.hide(node, place);
        }
        let linear = place.matrix.fixed_view::<2, 2>(0, 0).determinant().abs().sqrt();
        let mut pen = Pen::with_tolerance(ARC_SAGITTA_MM / linear);
        let lengths =
            viewport::Lengths { node, place: place.viewport, reading: self.reading };
        let exact = shape::draw(node, &lengths, &mut pen);
        pen.lift();
        let source = place.style.source();
        for (vertices, closed) in pen.curves {
            let vertices = transformed(&vertices, closed, place.matrix);
            self.copied += if place.is_copy { vertices.len() } else { 0 };
            let (layer, source) = (place.layer, source.clone());
            self.drawing.curves.push(Curve { layer, source, vertices, closed });
        }
        if !exact {
            self.unread(format!("<{}>", node.tag_name().name()), place.layer);
        }
    }

    fn unread(&mut self, kind: String, layer: &'static str) {
        *self.drawing.unread.entry((kind, layer)).or_default() += 1;
    }

    /// Counts what would be drawn if it were not switched off.
    fn hide(&mut self, node: Node, place: &Place) {
        let shapes = node.descendants().filter(|n| shape::is_shape(n.tag_name().name()));
        let Source { name, .. } = place.style.source();
        *self.drawing.hidden.entry(name).or_default() += shapes.count();
    }
}

impl Place {
    /// Goes on inside a viewport of its own.
    fn enter(&mut self, (matrix, viewport): (Matrix3<f64>, [f64; 2])) {
        self.matrix *= matrix;
        self.viewport = viewport;
    }
}

/// Whether a child of a `switch` is for a program that knows no extension and speaks English.
fn is_for_us(node: &Node) -> bool {
    let language = node.attribute("systemLanguage");
    node.attribute("requiredExtensions").is_none_or(|text| text.trim().is_empty())
        && language.is_none_or(|text| text.split(',').any(|l| l.trim().starts_with("en")))
}

fn matrix(t: Transform) -> Matrix3<f64> {
    Matrix3::new(t.a, t.c, t.e, t.b, t.d, t.f, 0.0, 0.0, 1.0)
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::LAYERS;
    use crate::geometry::{Point2, Rect};

    #[test]
    fn what_inkscape_makes_of_a_circle_is_read_in_its_place() {
        let text = r##"<svg xmlns="http://www.w3.org/2000/svg" width="2in" height="1in"
            viewBox="0 0 20 10"><g transform="translate(1,2)" style="stroke:#ff0000">
            <path d="m 5,3 a 2,2 0 0 1 -4,0 2,2 0 0 1 4,0 z"/></g>
            <text>SPAM</text></svg>"##;
        let drawing = read_svg(text.as_bytes(), &Reading::of(&LAYERS)).unwrap();
        let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
        assert!(curve.closed && curve.layer == "CUT_OUTER" && drawing.says_unit);
        let area = std::f64::consts::PI * 5.08 * 5.08;
        assert!((curve.contour().signed_area().abs() - area).abs() < 1e-9);
        assert!((curve.vertices[0].point - Point2::new(15.24, 12.7)).norm() < 1e-9);
        assert_eq!(drawing.unread.len(), 1);
    }

    #[test]
    fn round_corners_ellipses_and_quadratics_keep_their_area() {
        let read = |shape: &str| {
            let text = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="200mm"
                viewBox="0 0 200 200"><g transform="rotate(10)">{shape}</g></svg>"#
            );
            let drawing = read_svg(text.as_bytes(), &Reading::of(&LAYERS)).unwrap();
            let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
            assert!(curve.closed && drawing.unread.is_empty(), "{drawing:?}");
            curve.contour().signed_area().abs()
        };
        let pi = std::f64::consts::PI;
        let rounded = 60.0 * 40.0 - (4.0 - pi) * 36.0;
        let uneven = 60.0 * 40.0 - (4.0 - pi) * 18.0;
        let ellipse = pi * 450.0;
        for (shape, wanted) in [
            (r#"<rect x="9" y="9" width="60" height="40" rx="6"/>"#, rounded),
            (r#"<rect x="9" y="9" width="60" height="40" rx="6" ry="3"/>"#, uneven),
            (r#"<rect width="60" height="12" ry="99"/>"#, pi * 180.0),
            (r#"<ellipse cx="90" cy="50" rx="30" ry="15"/>"#, ellipse),
            (r#"<path d="M60 50 a30 15 0 0 1 60 0 30 15 0 0 1 -60 0z"/>"#, ellipse),
            (r#"<path d="M0 0 q 30 30 60 0 t 60 0 V 60 H 0 z"/>"#, 7200.0),
        ] {
            let area = read(shape);
            assert!((area / wanted - 1.0).abs() < 1e-3, "{shape}: {area}, {wanted}");
        }
    }

    #[test]
    fn what_is_no_svg_is_an_error() {
        assert!(read_svg(b"<html/>", &Reading::of(&LAYERS)).is_err());
        assert!(read_svg(b"\xff\xfe", &Reading::of(&LAYERS)).is_err());
        assert!(
            read_svg(
                b"<svg width='0' viewBox='0 0 0 0'><path d='M0 0zz'/></svg>",
                &Reading::of(&LAYERS)
            )
            .is_ok()
        );
    }

    /// Width and height of each curve of a drawing.
    fn sizes(text: &str) -> Vec<[f64; 2]> {
        let drawing = read_svg(text.as_bytes(), &Reading::of(&LAYERS)).unwrap();
        let size = |curve: &Curve| {
            let size = Rect::around(&curve.contour().flattened(0.001)).size();
            [size.x, size.y].map(|mm| (mm * 100.0).round() / 100.0)
        };
        drawing.curves.iter().map(size).collect()
    }

    #[test]
    fn a_drawing_is_as_large_as_a_browser_shows_it() {
        let rect = r#"<rect x="10" y="10" width="80" height="30"/>"#;
        let page = |attributes: &str| {
            let svg = r#"<svg xmlns="http://www.w3.org/2000/svg""#;
            sizes(&format!("{svg} {attributes}>{rect}</svg>"))
        };
        for (attributes, wanted) in [
            (r#"width="100mm" height="50mm" viewBox="0 0 100 50""#, [80.0, 30.0]),
            (r#"width="100mm" viewBox="0 0 100 50""#, [80.0, 30.0]),
            (r#"height="50mm" viewBox="0 0 100 50""#, [80.0, 30.0]),
            (r#"width="100mm" height="100mm" viewBox="0 0 100 50""#, [80.0, 30.0]),
            (
                r#"width="100mm" height="100mm" viewBox="0 0 100 50" preserveAspectRatio="none""#,
                [80.0, 60.0],
            ),
            (
                r#"width="100mm" height="100mm" viewBox="0 0 100 50" preserveAspectRatio="xMinYMin slice""#,
                [160.0, 60.0],
            ),
            (r#"width="210mm" height="297mm""#, [21.17, 7.94]),
            (r#"width="96" height="96" viewBox="0 0 48 48""#, [42.33, 15.88]),
            (r#"width="100%" viewBox="0 0 100 50""#, [21.17, 7.94]),
            ("", [21.17, 7.94]),
        ] {
            assert_eq!(page(attributes), [wanted], "{attributes}");
        }
    }

    #[test]
    fn copies_symbols_nested_drawings_and_switches_are_drawn() {
        let inside = r##"<defs><rect id="a" width="3cm" height="20"/>
            <symbol id="s" viewBox="0 0 10 10"><rect width="10" height="5"/></symbol></defs>
            <use href="#a" x="40"/><use xlink:href="#a" transform="scale(2,1)"/>
            <use href="#s" width="40" height="40"/><use href="#gone"/><use id="l" href="#l"/>
            <svg x="5" width="50" height="50" viewBox="0 0 5 5"><path d="M0 0h4v4z"/></svg>
            <switch><foreignObject requiredExtensions="x"/><g><rect width="50%" height="6"/></g>
            <g><rect width="7" height="7"/></g></switch>
            <circle r="10" transform="scale(2,1)"/>"##;
        let text = format!(
            r#"<!DOCTYPE svg [<!ENTITY big "<rect width='9' height='8'/>">]>
            <svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
            width="200mm" height="50mm" viewBox="0 0 200 50">{inside}&big;</svg>"#
        );
        let cm = |count: f64| (count * 960.0 / 25.4 * 100.0).round() / 100.0;
        let wanted = [
            [cm(3.0), 20.0],
            [cm(6.0), 20.0],
            [40.0, 20.0],
            [40.0, 40.0],
            [100.0, 6.0],
            [40.0, 20.0],
            [9.0, 8.0],
        ];
        assert_eq!(sizes(&text), wanted);
    }

    #[test]
    fn what_is_switched_off_is_counted_and_classes_colour_lines() {
        let text = r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:i="urn:i" width="9mm"
            viewBox="0 0 9 9"><style>.e, #u { stroke: #00ffff } g .off{display:none}</style>
            <g i:label="Plan" style="display:none"><rect width="1" height="1"/></g>
            <g visibility="hidden"><rect width="2" height="2"/>
            <rect visibility="visible" class="e" width="3" height="3"/>
            <rect class="off" width="4" height="4"/></g></svg>"##;
        let drawing = read_svg(text.as_bytes(), &Reading::of(&LAYERS)).unwrap();
        let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
        assert_eq!((curve.layer, curve.source.rgb), ("ENGRAVE", Some([0, 255, 255])));
        let hidden: Vec<_> = drawing.hidden.into_iter().collect();
        assert_eq!(hidden, [(String::new(), 2), ("Plan".to_owned(), 1)]);
    }

    #[test]
    fn copies_of_copies_end_and_are_told() {
        let copies = |k: usize| {
            let one = format!("<use href='#g{}'/>", k - 1);
            format!("<g id='g{k}'>{}</g>", one.repeat(10))
        };
        let groups: String = (1..12).map(copies).collect();
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='1mm' viewBox='0 0 1 1'>\
             <defs><g id='g0'><path d='M0 0'/></g>{groups}</defs><use href='#g11'/></svg>"
        );
        let drawing = read_svg(text.as_bytes(), &Reading::of(&LAYERS)).unwrap();
        assert!(!drawing.unread.is_empty());
    }
}
