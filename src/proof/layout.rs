//! Whether the drawn parts keep apart from each other and from the sheet's edge, as drawn.

use crate::geometry::Point2;
use crate::geometry::predicates::{self, contains};
use crate::manifest::StockEntry;
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::shape::{Edges, bounds, foot};
use crate::tolerance::{ARC_SAGITTA_MM, SPACING_SLACK_MM};
use std::collections::BTreeMap;

/// Outlines of one sheet as drawn, arcs flattened, with the name of the part in each.
pub(super) struct Laid<'a> {
    pub file: &'a str,
    pub rings: Vec<(String, Vec<Point2>)>,
    pub stock: &'a StockEntry,
}

/// How two outlines are to each other, and where.
#[derive(Clone, Copy)]
struct Near {
    distance: f64,
    at: Point2,
}

impl Laid<'_> {
    /// Everything too near.
    pub(super) fn findings(&self) -> Vec<ProofFinding> {
        let pairs = self.pairs().into_iter();
        let spot = |[a, b]: [usize; 2], at| {
            let (a, b) = (&self.rings[a].0, &self.rings[b].0);
            Spot::file(self.file).part(a).part(b).at(at)
        };
        let between = pairs.map(|(pair, near)| {
            let (distance_mm, least_mm) = (near.distance, self.stock.spacing);
            let spot = spot(pair, near.at);
            match near.distance > 0.0 {
                true => ProofFinding::PartsTooNear { spot, distance_mm, least_mm },
                false => ProofFinding::PartsOverlap { spot },
            }
        });
        between.chain(self.in_margin()).collect()
    }

    fn pairs(&self) -> BTreeMap<[usize; 2], Near> {
        let rings = || self.rings.iter().map(|(_, ring)| ring);
        let edges = Edges::for_reach(rings(), self.stock.spacing);
        let owners: Vec<usize> = rings()
            .enumerate()
            .flat_map(|(owner, ring)| std::iter::repeat_n(owner, ring.len()))
            .collect();
        let mut pairs: BTreeMap<[usize; 2], Near> = BTreeMap::new();
        let mut note = |a: usize, b: usize, near: Near| {
            let known = pairs.entry([a.min(b), a.max(b)]).or_insert(near);
            if near.distance < known.distance {
                *known = near;
            }
        };
        let least = self.stock.spacing - ARC_SAGITTA_MM - SPACING_SLACK_MM;
        for (k, &owner) in owners.iter().enumerate() {
            let [a, b] = edges.edge(k);
            for p in edges.samples(k, 0.5) {
                for other in edges.around(p).filter(|&other| owners[other] != owner) {
                    let [c, d] = edges.edge(other);
                    let distance = (a - foot(a, c, d)).norm();
                    if predicates::segments_meet(a, b, c, d) {
                        note(owner, owners[other], Near { distance: 0.0, at: p });
                    } else if distance < least {
                        note(owner, owners[other], Near { distance, at: a });
                    }
                }
            }
        }
        for (inner, ring) in rings().enumerate() {
            for (outer, hull) in rings().enumerate() {
                let [low, high] = bounds(hull.iter().copied());
                let p = ring[0];
                let boxed =
                    low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
                if inner != outer && boxed && contains(hull, p) {
                    note(inner, outer, Near { distance: 0.0, at: p });
                }
            }
        }
        pairs
    }

    fn in_margin(&self) -> impl Iterator<Item = ProofFinding> + '_ {
        let stock = self.stock;
        let out = move |p: &Point2| {
            let low = (stock.margin - p.x).max(stock.margin - p.y);
            low.max(p.x - stock.width + stock.margin)
                .max(p.y - stock.height + stock.margin)
        };
        self.rings.iter().filter_map(move |(part, ring)| {
            let worst = ring.iter().max_by(|a, b| out(a).total_cmp(&out(b)))?;
            let by_mm = out(worst);
            let spot = || Spot::file(self.file).part(part).at(*worst);
            (by_mm > SPACING_SLACK_MM)
                .then(|| ProofFinding::PartInMargin { spot: spot(), by_mm })
        })
    }
}
