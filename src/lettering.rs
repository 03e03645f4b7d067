//! stub
use crate::geometry::Point2;
/// x
pub struct Lettering {
    pub strokes: Vec<Vec<Point2>>,
}
/// x
pub fn letter(_t: &str, _h: f64) -> Result<Lettering, ()> {
    Ok(Lettering { strokes: vec![] })
}
/// x
pub fn width(t: &str, h: f64) -> Result<f64, ()> {
    Ok(t.len() as f64 * h)
}
