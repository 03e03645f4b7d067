//! PDF: the paths of each page with their layers (optional content, ISO 32000-1 §8.11).
//!
//! `hayro-syntax` reads objects and streams; of the content only paths, their colour and
//! the matrix are followed.

use crate::drawing::{Curve, Drawing, DrawingError, Pen, chain, is_cut};
use crate::drawing::{KnownLayer, Reading, Source, layer_coloured, layer_named};
use crate::geometry::{Point2, Vector2, Vertex};
use crate::tolerance::JOINED_MM;
use hayro_syntax::content::Instruction;
use hayro_syntax::object::{self, Dict, Name, Object};
use hayro_syntax::page::Page;
use hayro_syntax::{LoadPdfError, Pdf};
use nalgebra::Matrix3;

const MM_PER_POINT: f64 = 25.4 / 72.0;

/// Reads the lines of each page, in millimetres.
///
/// # Errors
/// [`DrawingError`] if the bytes are no PDF, or one that asks for a password.
pub fn read_pdf(bytes: &[u8], reading: &Reading) -> Result<Vec<Drawing>, DrawingError> {
    let pdf = Pdf::new(bytes.to_vec()).map_err(|error| {
        let message = match error {
            LoadPdfError::Decryption(_) => "the PDF is encrypted",
            LoadPdfError::Invalid => "this is no PDF",
        };
        DrawingError::Other { message: message.to_owned() }
    })?;
    Ok(pdf.pages().iter().map(|page| drawing(page, reading.known)).collect())
}

fn drawing(page: &Page, known: &[KnownLayer]) -> Drawing {
    let corner = page.media_box();
    let scale = Matrix3::new_scaling(MM_PER_POINT);
    let shift = Vector2::new(-corner.x0, -corner.y0);
    let matrix = scale * Matrix3::new_translation(&shift);
    let mut reader = Reader {
        known,
        layers: layers(page, known),
        drawing: Drawing { says_unit: true, ..Drawing::default() },
        state: State { matrix, colour: "" },
        saved: Vec::new(),
        marked: Vec::new(),
        pen: Pen::default(),
    };
    let mut operations = page.operations();
    while let Some(operation) = operations.next() {
        reader.follow(&operation);
    }
    chain::joined(reader.drawing, JOINED_MM, |c| is_cut(c.layer).then_some(c.layer))
}

/// The names by which the page calls our layers.
fn layers(page: &Page, known: &[KnownLayer]) -> Vec<(Vec<u8>, &'static str)> {
    let properties = &page.resources().properties;
    let layer = |key: Name| {
        let group = properties.get::<Dict>(&key)?;
        let name = group.get::<object::String>(b"Name")?;
        let layer = layer_named(known, &String::from_utf8_lossy(name.as_bytes()))?;
        Some((key.to_vec(), layer))
    };
    properties.keys().filter_map(layer).collect()
}

/// Numbers have single precision, as in most programs that draw them.
fn number(operand: &Object) -> f64 {
    match operand {
        Object::Number(number) => f64::from(number.as_f32()),
        _ => 0.0,
    }
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
    fn follow(&mut self, operation: &Instruction) {
        let numbers: Vec<f64> = operation.operands().map(number).collect();
        let number = |k: usize| numbers.get(k).copied().unwrap_or(0.0);
        let operator = str::from_utf8(operation.operator).unwrap_or_default();
        let matrix = self.state.matrix;
        let at =
            |k: usize| matrix.transform_point(&Point2::new(number(k), number(k + 1)));
        match operator {
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
                let kind = operator.to_owned();
                *self.drawing.unread.entry((kind, layer)).or_default() += 1;
            }
            _ => {}
        }
    }

    fn layer(&self, operation: &Instruction) -> Option<&'static str> {
        let Some(Object::Name(name)) = operation.operands().nth(1) else { return None };
        let called = |(key, _): &&(Vec<u8>, _)| key.as_slice() == name.as_ref();
        self.layers.iter().find(called).map(|(_, layer)| *layer)
    }

    fn current_layer(&self) -> &'static str {
        let marked = self.marked.iter().rev().find_map(|layer| *layer);
        marked.unwrap_or(self.state.colour)
    }

    fn stroke(&mut self) {
        let layer = self.current_layer();
        self.pen.lift();
        let curves = std::mem::take(&mut self.pen).curves.into_iter();
        let curves = curves.map(|(vertices, closed)| Curve {
            layer,
            source: Source::default(),
            vertices,
            closed,
        });
        self.drawing.curves.extend(curves);
    }
}
