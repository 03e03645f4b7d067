//! PDF: the paths of each page with their layers (optional content, ISO 32000-1 §8.11).
//!
//! `lopdf` reads objects and streams; of the content only paths, their colour and the
//! matrix are followed.

use crate::drawing::{Curve, Drawing, DrawingError, Pen, chain, is_cut};
use crate::drawing::{KnownLayer, layer_coloured, layer_named};
use crate::geometry::{Point2, Vertex};
use lopdf::content::{Content, Operation};
use lopdf::{Document, Object, ObjectId};
use nalgebra::Matrix3;

const MM_PER_POINT: f64 = 25.4 / 72.0;

/// Reads the lines of each page, in millimetres.
///
/// # Errors
/// [`DrawingError`] if the bytes are no PDF.
pub fn read_pdf(
    bytes: &[u8],
    known: &[KnownLayer],
) -> Result<Vec<Drawing>, DrawingError> {
    let other = |error: lopdf::Error| DrawingError::Other { message: error.to_string() };
    let document = Document::load_mem(bytes).map_err(other)?;
    let pages = document.get_pages();
    pages.values().map(|&page| drawing(&document, page, known).map_err(other)).collect()
}

fn drawing(
    document: &Document,
    page: ObjectId,
    known: &[KnownLayer],
) -> Result<Drawing, lopdf::Error> {
    let content = Content::decode(&document.get_page_content(page))?;
    let origin = media_box(document, page).unwrap_or_default();
    let scale = Matrix3::new_scaling(MM_PER_POINT);
    let shift = nalgebra::Vector2::new(-origin[0], -origin[1]);
    let matrix = scale * Matrix3::new_translation(&shift);
    let mut reader = Reader {
        known,
        layers: layers(document, page, known),
        drawing: Drawing { says_unit: true, ..Drawing::default() },
        state: State { matrix, colour: "" },
        saved: Vec::new(),
        marked: Vec::new(),
        pen: Pen::default(),
    };
    for operation in &content.operations {
        reader.follow(operation);
    }
    Ok(chain::joined(reader.drawing, is_cut))
}

fn media_box(document: &Document, page: ObjectId) -> Option<[f64; 2]> {
    let corners =
        document.get_dictionary(page).ok()?.get_deref(b"MediaBox", document).ok()?;
    let number =
        |k: usize| Some(f64::from(corners.as_array().ok()?.get(k)?.as_float().ok()?));
    Some([number(0)?, number(1)?])
}

/// The names by which the page calls our layers.
fn layers(
    document: &Document,
    page: ObjectId,
    known: &[KnownLayer],
) -> Vec<(Vec<u8>, &'static str)> {
    let properties = || {
        let page = document.get_dictionary(page).ok()?;
        let resources = page.get_deref(b"Resources", document).ok()?.as_dict().ok()?;
        resources.get_deref(b"Properties", document).ok()?.as_dict().ok()
    };
    let named = properties().into_iter().flat_map(|names| names.iter());
    let layer = |(key, value): (&Vec<u8>, &Object)| {
        let group = document.dereference(value).ok()?.1.as_dict().ok()?;
        let name = group.get(b"Name").ok()?.as_str().ok()?;
        Some((key.clone(), layer_named(known, &String::from_utf8_lossy(name))?))
    };
    named.filter_map(layer).collect()
}

#[derive(Clone, Copy)]
struct State {
    matrix: Matrix3<f64>,
    /// Layer by the colour of strokes, for files whose layers are gone.
    colour: &'static str,
}

struct Reader<'a> {
    known: &'a [KnownLayer],
    layers: Vec<(Vec<u8>, &'static str)>,
    drawing: Drawing,
    state: State,
    saved: Vec<State>,
    /// Layers of the marked content that is open.
    marked: Vec<Option<&'static str>>,
    pen: Pen,
}

impl Reader<'_> {
    fn follow(&mut self, operation: &Operation) {
        let number = |k: usize| {
            let operand = operation.operands.get(k).and_then(|o| o.as_float().ok());
            operand.map_or(0.0, f64::from)
        };
        let matrix = self.state.matrix;
        let at =
            |k: usize| matrix.transform_point(&Point2::new(number(k), number(k + 1)));
        match operation.operator.as_str() {
            "q" => self.saved.push(self.state),
            "Q" => self.state = self.saved.pop().unwrap_or(self.state),
            "cm" => {
                let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(number);
                self.state.matrix *= Matrix3::new(a, c, e, b, d, f, 0.0, 0.0, 1.0);
            }
            "RG" => {
                let rgb = [0, 1, 2].map(|k| (number(k) * 255.0).round() as u8);
                self.state.colour = layer_coloured(self.known, rgb).unwrap_or("");
            }
            "BDC" | "BMC" => self.marked.push(self.layer(operation)),
            "EMC" => {
                self.marked.pop();
            }
            "m" => self.pen.move_to(at(0)),
            "l" => self.pen.line_to(at(0), 0.0),
            "c" => self.pen.curve_to([at(0), at(2), at(4)]),
            "v" => self.pen.curve_to([self.pen.at(), at(0), at(2)]),
            "y" => self.pen.curve_to([at(0), at(2), at(2)]),
            "h" => self.pen.close(),
            "re" => {
                let (x, y, w, h) = (number(0), number(1), number(2), number(3));
                let corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)];
                let corners =
                    corners.map(|(x, y)| matrix.transform_point(&Point2::new(x, y)));
                self.pen.lift();
                self.pen.curves.push((corners.map(Vertex::line).to_vec(), true));
            }
            "s" | "b" | "b*" => {
                self.pen.close();
                self.stroke();
            }
            "S" | "B" | "B*" => self.stroke(),
            "n" | "f" | "F" | "f*" => self.pen = Pen::default(),
            "Do" | "Tj" | "TJ" => {
                let layer = self.current_layer();
                let kind = operation.operator.clone();
                *self.drawing.unread.entry((kind, layer)).or_default() += 1;
            }
            _ => {}
        }
    }

    fn layer(&self, operation: &Operation) -> Option<&'static str> {
        let Some(Object::Name(name)) = operation.operands.get(1) else { return None };
        self.layers.iter().find(|(key, _)| key == name).map(|(_, layer)| *layer)
    }

    fn current_layer(&self) -> &'static str {
        let marked = self.marked.iter().rev().find_map(|layer| *layer);
        marked.unwrap_or(self.state.colour)
    }

    fn stroke(&mut self) {
        let layer = self.current_layer();
        self.pen.lift();
        let curves = std::mem::take(&mut self.pen).curves.into_iter();
        let curves = curves.map(|(vertices, closed)| Curve { layer, vertices, closed });
        self.drawing.curves.extend(curves);
    }
}
