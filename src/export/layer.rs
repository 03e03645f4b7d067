//! The layers of a cut file: their names, colours and order.

use crate::drawing::KnownLayer;
use crate::sheets::{Operation, Path, Sheet};

/// A layer of a cut file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layer {
    /// Its name in DXF, SVG and PDF.
    pub name: &'static str,
    /// Its colour in DXF (AutoCAD Color Index).
    pub aci: u8,
    /// Its colour in SVG and PDF; pure primaries, which laser drivers tell apart.
    pub rgb: [u8; 3],
    /// What is drawn on it; `None` is the frame, which is never cut.
    pub operation: Option<Operation>,
}

/// All layers in drawing order, which many lasers take as the order of work.
pub const LAYERS: [Layer; 5] = [
    of(Operation::Engrave, 4, [0, 255, 255]),
    of(Operation::Score, 3, [0, 255, 0]),
    of(Operation::CutInner, 5, [0, 0, 255]),
    of(Operation::CutOuter, 1, [255, 0, 0]),
    Layer { name: "SHEET", aci: 8, rgb: [128, 128, 128], operation: None },
];

const fn of(operation: Operation, aci: u8, rgb: [u8; 3]) -> Layer {
    Layer { name: operation.layer(), aci, rgb, operation: Some(operation) }
}

impl Layer {
    /// The layer as a reader of drawings looks for it.
    pub const fn known(&self) -> KnownLayer {
        KnownLayer { name: self.name, rgb: self.rgb }
    }

    /// The paths of a sheet on this layer, in the order of its strokes.
    pub fn paths<'a>(&self, sheet: &'a Sheet) -> Vec<&'a Path> {
        match self.operation {
            None => sheet.frame.iter().collect(),
            Some(operation) => {
                let strokes = sheet.strokes.iter();
                strokes.filter(|s| s.operation == operation).map(|s| &s.path).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_stand_in_the_order_of_work_and_the_frame_last() {
        let operations: Vec<_> = LAYERS.iter().filter_map(|l| l.operation).collect();
        assert_eq!(operations, Operation::ALL);
        assert_eq!(LAYERS[4].name, "SHEET");
    }
}
