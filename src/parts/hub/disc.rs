//! A disc: hole, windows, ring, and what is engraved on it.
//!
//! The origin is the node axis, the first fin runs along x, and the labelled face looks
//! up the axis. A small key hole on the clockwise side of a window tells a disc that
//! is upside down: then it lies on the other side, and a wire does not go through both.

use crate::geometry::{Contour, Point2, Region, Vector2, Vertex, trig};
use crate::lettering::{letter, width};
use crate::parts::chain::{circle, quarter, without_doubles};
use crate::parts::connector::PlateText;
use crate::parts::fit::Fit;
use crate::parts::hub::dimensions::Hub;
use crate::parts::mark::{GAP, Mark, MarkKind};
use crate::tolerance::SAME_FOLD;
use std::f64::consts::FRAC_PI_2;

/// Radius of the key hole, mm: a wire goes through.
const KEY_RADIUS: f64 = 0.75;

/// Letters on discs are at least this share of the template's height.
const SHARES: [f64; 5] = [1.0, 0.85, 0.7, 0.6, 0.5];

/// A frame on the disc: a direction from the axis and the one a quarter turn on.
#[derive(Clone, Copy)]
struct Ray {
    out: Vector2,
    left: Vector2,
}

impl Ray {
    fn new(bearing: f64) -> Self {
        let out = Vector2::new(trig::cos(bearing), trig::sin(bearing));
        Self { out, left: Vector2::new(-out.y, out.x) }
    }

    fn at(self, s: f64, aside: f64) -> Point2 {
        Point2::from(self.out * s + self.left * aside)
    }
}

/// The shape of a hub's discs.
pub(crate) fn region(hub: &Hub, fit: &Fit) -> Region {
    let windows = hub.star.fins.iter().map(|fin| window(hub, fit, fin.bearing));
    let key = key(hub, fit).map(|center| circle(center, KEY_RADIUS).reversed());
    let rod = circle(Point2::origin(), hub.hole).reversed();
    let holes = std::iter::once(rod).chain(windows).chain(key).collect();
    Region { outline: circle(Point2::origin(), hub.radius), holes }
}

/// A window, clockwise: full-width walls along the slot, rounded corners beyond.
fn window(hub: &Hub, fit: &Fit, bearing: f64) -> Contour {
    let ray = Ray::new(bearing);
    let half = hub.width / 2.0;
    let radius = fit.relief.min(half);
    let bulge = if radius > 0.0 { -quarter(radius) } else { 0.0 };
    let (near, far) = (hub.inner, hub.inner + hub.slot);
    let mut vertices = vec![
        Vertex::line(ray.at(near, half)),
        Vertex::arc(ray.at(far, half), bulge),
        Vertex::line(ray.at(far + radius, half - radius)),
        Vertex::arc(ray.at(far + radius, radius - half), bulge),
        Vertex::line(ray.at(far, -half)),
        Vertex::arc(ray.at(near, -half), bulge),
        Vertex::line(ray.at(near - radius, radius - half)),
        Vertex::arc(ray.at(near - radius, half - radius), bulge),
    ];
    without_doubles(&mut vertices);
    if radius <= 0.0 {
        vertices.pop();
    }
    Contour { vertices }
}

/// Where the key hole is: in the widest sector with room, on the clockwise side of the window
/// that ends it (names stand on the other side of windows), a web from it and from the rim.
fn key(hub: &Hub, fit: &Fit) -> Option<Point2> {
    let sectors = hub.star.sectors();
    let mut order: Vec<usize> = (0..sectors.len()).collect();
    // Sectors that rounding alone tells apart stay in their order.
    order.sort_by_key(|&place| -(sectors[place] / SAME_FOLD).round() as i64);
    let fins = &hub.star.fins;
    let (reach, aside) =
        (hub.radius - fit.web - KEY_RADIUS, hub.width / 2.0 + fit.web + KEY_RADIUS);
    let along = (reach * reach - aside * aside).max(0.0).sqrt();
    order.into_iter().find_map(|place| {
        let before = Ray::new(fins[place].bearing);
        let middle = Ray::new(fins[place].bearing + sectors[place] / 2.0);
        let ray = Ray::new(fins[(place + 1) % fins.len()].bearing);
        let center = ray.at(along, -aside);
        let way = center.coords;
        // The other window is on its own side of the axis only.
        let free = way.dot(&before.out) <= 0.0 || way.dot(&before.left).abs() >= aside;
        let rod = way.norm() >= hub.hole + fit.web + KEY_RADIUS;
        // Turned over, the disc has no hole there.
        let tells = way.dot(&middle.left).abs() >= KEY_RADIUS;
        (free && rod && tells).then_some(center)
    })
}

/// Engraved on the upper face: the node, and beside each window the fin that stands there.
/// The second value counts texts that found no room.
pub(crate) fn marks(hub: &Hub, fit: &Fit, text: &PlateText) -> (Vec<Mark>, usize) {
    let mut free = Free::new(hub, fit);
    let mut marks = Vec::new();
    let mut missing = 0;
    for (fin, name) in hub.star.fins.iter().zip(text.fins) {
        let places = beside(hub, Ray::new(fin.bearing));
        match free.write(name, text.height, &places) {
            Some(strokes) => marks.push(Mark { kind: MarkKind::Engrave, strokes }),
            None => missing += 1,
        }
    }
    let places = anywhere(hub);
    let named = [format!("{} UP", text.name), text.name.to_owned()];
    match named.iter().find_map(|name| free.write(name, text.height, &places)) {
        Some(strokes) => marks.push(Mark { kind: MarkKind::Engrave, strokes }),
        None => missing += 1,
    }
    (marks, missing)
}

/// A direction to write in, and where the middle of the text's foot stands: along it and
/// aside.
type Place = (Ray, f64, f64);

/// Outward along a window, on its counter-clockwise side, as near to it as can be.
fn beside(hub: &Hub, ray: Ray) -> Vec<Place> {
    let steps = (hub.radius.min(MOST_INWARD) / STEP) as u32;
    // A little more than the gap, so that rounding does not take a place away.
    let aside = hub.width / 2.0 + GAP + STEP / 10.0;
    (0..steps).map(|k| (ray, hub.radius - f64::from(k) * STEP, aside)).collect()
}

/// Across the sectors, widest first, from the rim inward.
fn anywhere(hub: &Hub) -> Vec<Place> {
    let mut sectors: Vec<(f64, f64)> = hub
        .star
        .sectors()
        .into_iter()
        .zip(hub.star.fins.iter().map(|fin| fin.bearing))
        .collect();
    sectors.sort_by(|a, b| b.0.total_cmp(&a.0));
    let steps = (hub.radius.min(MOST_INWARD) / STEP) as u32;
    let places = sectors.into_iter().flat_map(|(angle, start)| {
        [0.5, 0.4, 0.6, 0.3, 0.7].into_iter().flat_map(move |share| {
            // Across the middle of the sector, feet toward the axis.
            let ray = Ray::new(start + angle * share - FRAC_PI_2);
            (0..steps).map(move |k| (ray, 0.0, hub.radius - f64::from(k) * STEP))
        })
    });
    places.collect()
}

/// How finely places for letters are tried, mm.
const STEP: f64 = 1.0;

/// How far inward from the rim they are tried, mm: no sheet takes a larger disc.
const MOST_INWARD: f64 = 2000.0;

/// A rectangle on the disc.
#[derive(Clone, Copy)]
struct Panel {
    ray: Ray,
    /// Along and across the ray, from and to.
    along: [f64; 2],
    across: [f64; 2],
}

impl Panel {
    fn corners(self) -> [Point2; 4] {
        let ([s, t], [v, w]) = (self.along, self.across);
        [(s, v), (t, v), (t, w), (s, w)].map(|(s, v)| self.ray.at(s, v))
    }

    /// From a point to the nearest of the rectangle.
    fn distance(self, p: Point2) -> f64 {
        let beyond = |x: f64, [low, high]: [f64; 2]| (low - x).max(x - high).max(0.0);
        let out = beyond(p.coords.dot(&self.ray.out), self.along);
        Vector2::new(out, beyond(p.coords.dot(&self.ray.left), self.across)).norm()
    }

    /// Whether a line along one of the rectangles' sides keeps them [`GAP`] apart.
    fn is_clear_of(self, other: Self) -> bool {
        let (mine, theirs) = (self.corners(), other.corners());
        let parts = |way: Vector2| {
            let low = |c: &[Point2; 4]| {
                c.iter().map(|p| p.coords.dot(&way)).fold(f64::INFINITY, f64::min)
            };
            let high = |c: &[Point2; 4]| {
                c.iter().map(|p| p.coords.dot(&way)).fold(f64::NEG_INFINITY, f64::max)
            };
            low(&theirs) - high(&mine) >= GAP || low(&mine) - high(&theirs) >= GAP
        };
        let ways = [self.ray.out, self.ray.left, other.ray.out, other.ray.left];
        ways.into_iter().any(parts)
    }
}

/// What is left of a disc to write on.
struct Free {
    radius: f64,
    holes: Vec<(Point2, f64)>,
    panels: Vec<Panel>,
}

impl Free {
    fn new(hub: &Hub, fit: &Fit) -> Self {
        let (half, relief) = (hub.width / 2.0, fit.relief);
        let window = |bearing: f64| Panel {
            ray: Ray::new(bearing),
            along: [hub.inner - relief, hub.inner + hub.slot + relief],
            across: [-half, half],
        };
        let rod = (Point2::origin(), hub.hole);
        let key = key(hub, fit).map(|center| (center, KEY_RADIUS));
        Self {
            radius: hub.radius,
            holes: std::iter::once(rod).chain(key).collect(),
            panels: hub.star.fins.iter().map(|fin| window(fin.bearing)).collect(),
        }
    }

    /// The text at the first place where it is free, as large as there is room; the place
    /// is then taken.
    fn write(
        &mut self,
        text: &str,
        height: f64,
        places: &[Place],
    ) -> Option<Vec<Vec<Point2>>> {
        let (panel, share) = SHARES.iter().find_map(|share| {
            let long = width(text, height * share).ok()?;
            let panel = |&(ray, s, aside): &Place| Panel {
                ray,
                along: [s - long / 2.0, s + long / 2.0],
                across: [aside, aside + height * share],
            };
            let panels = places.iter().map(panel);
            panels.into_iter().find(|&panel| self.is_free(panel)).map(|p| (p, share))
        })?;
        self.panels.push(panel);
        let lettering = letter(text, height * share).ok()?;
        let map = |p: &Point2| panel.ray.at(panel.along[0] + p.x, panel.across[0] + p.y);
        Some(lettering.strokes.iter().map(|s| s.iter().map(map).collect()).collect())
    }

    fn is_free(&self, panel: Panel) -> bool {
        panel.corners().iter().all(|p| p.coords.norm() + GAP <= self.radius)
            && self.holes.iter().all(|&(p, radius)| panel.distance(p) >= radius + GAP)
            && self.panels.iter().all(|&other| panel.is_clear_of(other))
    }
}
