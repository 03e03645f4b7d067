//! The structure seen from one side in parallel projection, for pictures of steps.

use crate::fabrication::Fabrication;
use crate::geometry::Point2;
use crate::ids::PartId;
use crate::picture::Camera;
use crate::report::fins;
use crate::structure::Structure;

/// Where pictures are seen from: radians around and up.
pub(super) const FROM: [f64; 2] = [-1.1, 0.6];

/// A fin or a plate of a connector as it is seen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Panel {
    /// Index of its part.
    pub part: PartId,
    /// Its corners: x to the right, y up.
    pub corners: [Point2; 4],
}

/// All fins that are on parts and all plates, the farthest first.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Picture {
    /// Far to near.
    pub panels: Vec<Panel>,
    /// Extent of the picture.
    pub size: [f64; 2],
}

impl Picture {
    /// The picture of a job, as wide as `width`, its lower left corner in the origin.
    pub(super) fn new(job: &Fabrication, structure: &Structure, width: f64) -> Self {
        let camera = Camera::level(FROM);
        let mut panels: Vec<(f64, Panel)> = Vec::new();
        for (part, made) in job.parts_with_ids() {
            let fins =
                fins::of_part(made).into_iter().map(|fin| structure.corners(fin.ends()));
            for corners in fins.chain(fins::plates(structure, made)) {
                let corners = corners.map(|p| p.coords);
                let depth = corners.iter().map(|p| camera.nearness(p)).sum();
                panels.push((
                    depth,
                    Panel { part, corners: corners.map(|p| camera.flat(&p)) },
                ));
            }
        }
        panels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut panels: Vec<Panel> = panels.into_iter().map(|(_, panel)| panel).collect();
        let size = fitted(&mut panels, width);
        Self { panels, size }
    }
}

/// Moves and scales panels to a width; their extent then.
fn fitted(panels: &mut [Panel], width: f64) -> [f64; 2] {
    let points = || panels.iter().flat_map(|panel| panel.corners);
    let Some(low) = points().reduce(|a, b| a.inf(&b)) else { return [width, 0.0] };
    let high = points().fold(low, |a, b| a.sup(&b));
    let scale = width / (high.x - low.x).max(f64::MIN_POSITIVE);
    for corner in panels.iter_mut().flat_map(|panel| &mut panel.corners) {
        *corner = Point2::from((*corner - low) * scale);
    }
    [width, (high.y - low.y) * scale]
}
