//! A node as it is built: its fins, cut off some way out, and the plates that hold them.
//!
//! Every part is a slab over its flat shape; a ray per pixel finds the first slab it meets
//! (parallel projection). So what is seen is what is cut, notches, slits and all.

use crate::fabrication::Fabrication;
use crate::geometry::{Point2, Point3, Vector2, Vector3, trig};
use crate::ids::NodeId;
use crate::parts::{Body, ConnectorBody, Part};
use crate::picture::{self, Camera, PngError};
use crate::structure::Structure;
use crate::tolerance::ARC_SAGITTA_MM;
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Width and height of the picture, pixels.
const SIZE: usize = 640;
/// Rays per pixel along each side.
const FINE: usize = 2;
/// Width of a cell of a slab's shape, mm.
const CELL: f64 = 0.1;
/// Directions from which it is seen: radians around and up.
const FROM: [f64; 2] = [-1.0, 0.72];
/// How far fins are shown, as a share of what their connector takes.
const SHOWN: f64 = 1.9;

const FIN: [f64; 3] = [0.62, 0.76, 0.86];
const PLATE: [f64; 3] = [0.98, 0.66, 0.28];

/// The picture of a node as PNG, fins `thickness` mm thick; `None` if no connector is there.
///
/// # Errors
/// [`PngError`] if it cannot be packed.
pub fn node_picture(
    job: &Fabrication,
    node: NodeId,
    thickness: f64,
) -> Result<Option<Vec<u8>>, PngError> {
    let Some(structure) = &job.structure else { return Ok(None) };
    let connector = job.parts.iter().find_map(|part| match &part.body {
        Body::Connector(body) if body.node() == node => Some((part, body)),
        _ => None,
    });
    let Some(connector) = connector else { return Ok(None) };
    let out = SHOWN * connector.1.reach;
    let mut slabs = plates(structure, connector);
    for part in &job.parts {
        slabs.extend(ends(structure, part, node, (out, thickness)));
    }
    let camera = Camera::about(&structure.nodes()[node].axis, FROM);
    let scale =
        2.3 * out.max(structure.nodes()[node].height() * 0.8) / (SIZE * FINE) as f64;
    let rays: Vec<Option<Hit>> = (0..SIZE * FINE * SIZE * FINE)
        .map(|k| {
            let (x, y) = (k % (SIZE * FINE), k / (SIZE * FINE));
            let half = (SIZE * FINE) as f64 / 2.0;
            let from = camera.right * ((x as f64 - half) * scale)
                + camera.up * ((half - y as f64) * scale);
            first(&slabs, from, camera.toward)
        })
        .collect();
    drawn(&rays).map(|pixels| picture::png(&pixels)).transpose()
}

/// A part in space, relative to the node.
struct Slab {
    origin: Vector3,
    along: Vector3,
    across: Vector3,
    half: f64,
    shape: Mask,
    color: [f64; 3],
}

/// Which cells of a flat shape are material.
struct Mask {
    low: Point2,
    columns: usize,
    rows: usize,
    cells: Vec<bool>,
}

impl Mask {
    /// By scanlines; a point is material if an odd number of rings is around it.
    fn new(rings: &[Vec<Point2>]) -> Self {
        let points = || rings.iter().flatten().copied();
        let low = points().fold(Point2::new(f64::MAX, f64::MAX), |a, b| a.inf(&b));
        let high = points().fold(Point2::new(f64::MIN, f64::MIN), |a, b| a.sup(&b));
        let size = ((high - low) / CELL).map(|x| x.ceil().max(1.0) as usize);
        let (columns, rows) = (size.x, size.y);
        let mut cells = vec![false; columns * rows];
        for row in 0..rows {
            let y = low.y + (row as f64 + 0.5) * CELL;
            let mut met: Vec<f64> =
                rings.iter().flat_map(|ring| crossings(ring, y)).collect();
            met.sort_by(f64::total_cmp);
            for pair in met.chunks_exact(2) {
                let column = |x: f64| {
                    (((x - low.x) / CELL).round().max(0.0) as usize).min(columns)
                };
                cells[row * columns + column(pair[0])..row * columns + column(pair[1])]
                    .fill(true);
            }
        }
        Self { low, columns, rows, cells }
    }

    fn has(&self, p: Vector2) -> bool {
        let cell = (Point2::from(p) - self.low) / CELL;
        let (x, y) = (cell.x.floor(), cell.y.floor());
        let inside =
            x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64;
        inside && self.cells[y as usize * self.columns + x as usize]
    }
}

fn crossings(ring: &[Point2], y: f64) -> Vec<f64> {
    let sides = ring.iter().zip(ring.iter().cycle().skip(1));
    let crossed = sides.filter(|(a, b)| (a.y > y) != (b.y > y));
    crossed.map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)).collect()
}

fn plates(structure: &Structure, (part, body): (&Part, &ConnectorBody)) -> Vec<Slab> {
    let axis = structure.nodes()[body.node()].axis;
    let Some(fin) = body.star.fins.first() else { return Vec::new() };
    let first = structure.direction(body.node(), fin.to);
    let side = axis.cross(&first);
    let rings: Vec<Vec<Point2>> =
        part.region.contours().map(|c| c.flattened(ARC_SAGITTA_MM)).collect();
    let copies = body.plates.copies.iter().map(|copy| {
        let (sin, cos) = (trig::sin(copy.bearing), trig::cos(copy.bearing));
        Slab {
            origin: axis * copy.height,
            along: first * cos + side * sin,
            across: side * cos - first * sin,
            half: body.plates.thickness / 2.0,
            shape: Mask::new(&rings),
            color: PLATE,
        }
    });
    copies.collect()
}

/// The ends of a part on the node, cut off `out` from its axis.
fn ends(
    structure: &Structure,
    part: &Part,
    node: NodeId,
    (out, thickness): (f64, f64),
) -> Vec<Slab> {
    let tips = part.body.tips().into_iter().filter(|tip| tip.axis.node == node);
    let outline = part.region.outline.flattened(ARC_SAGITTA_MM);
    tips.map(|tip| {
        let ring = outline.iter().map(|p| {
            let way = p - tip.axis.foot;
            let s = way.dot(&tip.inward).clamp(0.0, out);
            Point2::new(s, way.dot(&tip.axis.up))
        });
        Slab {
            origin: Vector3::zeros(),
            along: structure.direction(node, tip.to),
            across: structure.nodes()[node].axis,
            half: thickness / 2.0,
            shape: Mask::new(&[ring.collect()]),
            color: FIN,
        }
    })
    .collect()
}

/// What a ray meets first.
#[derive(Clone, Copy)]
struct Hit {
    depth: f64,
    slab: usize,
    /// 0 on the face, 1 on a side.
    side: u8,
    color: [f64; 3],
}

fn first(slabs: &[Slab], from: Vector3, toward: Vector3) -> Option<Hit> {
    let hits = slabs.iter().enumerate().filter_map(|(k, slab)| slab.hit(k, from, toward));
    hits.max_by(|a, b| a.depth.total_cmp(&b.depth))
}

impl Slab {
    fn hit(&self, slab: usize, from: Vector3, toward: Vector3) -> Option<Hit> {
        let normal = self.along.cross(&self.across);
        let (rate, off) = (toward.dot(&normal), (from - self.origin).dot(&normal));
        // Faces that are seen on edge would need no end of steps.
        let rate = if rate.abs() < 0.02 { 0.02_f64.copysign(rate) } else { rate };
        let (near, far) = {
            let (a, b) = ((self.half - off) / rate, (-self.half - off) / rate);
            (a.max(b), a.min(b))
        };
        let at = |t: f64| {
            let p: Vector3 = Point3::from(from + toward * t).coords - self.origin;
            Vector2::new(p.dot(&self.along), p.dot(&self.across))
        };
        let steps = ((near - far) / CELL).ceil().max(1.0) as usize;
        let step = (near - far) / steps as f64;
        let k = (0..=steps).find(|&k| self.shape.has(at(near - k as f64 * step)))?;
        let light = if k == 0 { 0.55 + 0.45 * rate.abs() } else { 0.5 };
        Some(Hit {
            depth: near - k as f64 * step,
            slab,
            side: u8::from(k > 0),
            color: self.color.map(|c| c * light),
        })
    }
}

/// Pixels of the mean of their rays, with dark lines where parts or faces end.
fn drawn(rays: &[Option<Hit>]) -> Option<Pixmap> {
    let wide = SIZE * FINE;
    let key = |k: usize| rays[k].map(|hit| (hit.slab, hit.side));
    let color = |x: usize, y: usize| {
        let k = y * wide + x;
        let edge = x + 1 < wide && key(k) != key(k + 1)
            || y + 1 < wide && key(k) != key(k + wide);
        match (edge, rays[k]) {
            (true, _) => [0.15; 3],
            (false, Some(hit)) => hit.color,
            (false, None) => [1.0; 3],
        }
    };
    let mut pixels = Pixmap::new(SIZE as u32, SIZE as u32)?;
    for (k, pixel) in pixels.pixels_mut().iter_mut().enumerate() {
        let (x, y) = (k % SIZE * FINE, k / SIZE * FINE);
        let mut sum = [0.0; 3];
        for (i, j) in (0..FINE).flat_map(|i| (0..FINE).map(move |j| (i, j))) {
            let of = color(x + i, y + j);
            (0..3).for_each(|c| sum[c] += of[c] / (FINE * FINE) as f64);
        }
        let [r, g, b] = sum.map(|c| (c * 255.0).round() as u8);
        *pixel = PremultipliedColorU8::from_rgba(r, g, b, 255)?;
    }
    Some(pixels)
}
