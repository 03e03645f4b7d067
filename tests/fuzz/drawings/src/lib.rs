//! What the targets do with a drawing once it is read: sort its lines into parts.

use finwright::drawing::{Drawing, DrawingError, KnownLayer, Reading, Rules, drawn_parts};
use finwright::export::LAYERS;

/// Reads some bytes, looking for our layers.
pub fn fuzz<T>(
    bytes: &[u8],
    read: impl Fn(&[u8], &Reading) -> Result<T, DrawingError>,
) -> Option<T> {
    let known: Vec<KnownLayer> = LAYERS.iter().map(|layer| layer.known()).collect();
    read(bytes, &Reading::of(&known)).ok()
}

/// Sorts the lines of a drawing into parts, with the gaps that a user would have closed.
pub fn sort(drawing: Drawing) {
    for join in [0.0, 0.5] {
        let rules = Rules { layers: Vec::new(), join };
        std::hint::black_box(drawn_parts(drawing.clone(), &rules));
    }
}
