//! From a structure in space to one flat part each.
//!
//! [`strips`] unfolds every strip, cuts the slits where strips cross, rounds and flares
//! them, splices what is too long for the stock and writes on each part what the maker
//! needs. Kerf is not its business, nor where parts lie on a sheet.

mod assembly;
mod clearance;
mod connector;
mod coupon;
mod fin;
mod finding;
mod fit;
mod hinge;
mod hub;
mod lap;
mod mark;
mod outline;
mod part;
mod setback;
mod star;
mod steps;
mod unfold;

pub use assembly::built::{Built, Form, Hit, Plates, Role, Snug, collisions};
pub use assembly::collisions::together;
pub use assembly::copy::{Copy, copies};
pub use connector::{Connector, connected, levers};
pub use coupon::{Fitted, Mark as CouponMark, coupon};
pub use finding::ConnectorFinding;
pub use fit::Fit;
pub use hinge::plate::Hinge;
pub use hub::dimensions::{Hub, inner_radius};
pub use lap::bend::bends;
pub use lap::finding::PartFinding;
pub use lap::insertion::{Insertion, insertion};
pub use lap::join::{End, Joinery, Joints, Opening, Slit, join};
pub use lap::placement::{Hubs, Lapped, lapped};
pub use mark::{FoldMarks, Marking};
pub use outline::{Closure, HeldEnd, Piece, outline};
pub use part::{Body, ConnectorBody, FinBody, Mark, MarkKind, Part, StripBody, Tip};
pub use setback::{clear_of, setback};
pub use star::{Around, Spoke};
pub use steps::{Step, steps};
pub use unfold::{FlatAxis, FlatStrip, Fold, unfold};

use crate::diagnostic::Finding;
use crate::geometry::{Point2, Region, predicates};
use crate::ids::NodeId;
use crate::structure::Structure;
use crate::tolerance::ARC_SAGITTA_MM;
use lap::placement::{Plan, plan};
use lap::splice::{self, Whole};
use lap::strength::{self, Slitted};
use std::collections::BTreeMap;

/// What parts are made for.
pub struct Making<'a> {
    /// What material and joint ask.
    pub fit: &'a Fit,
    /// How parts are marked.
    pub marking: Marking,
    /// Whether an outline fits some sheet of the stock.
    pub fits: &'a dyn Fn(&[Point2]) -> bool,
}

/// A structure as parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// The structure with its strips as they were cut: closed ones opened at their
    /// smallest fold, those that would lie over themselves or run through discs split.
    pub structure: Structure,
    /// Strips in the order of assembly, or fins in that of the structure; then connectors in
    /// the order of nodes.
    pub parts: Vec<Part>,
    /// In which order they go together.
    pub steps: Vec<Step>,
    /// Everything found on the way.
    pub findings: Vec<Finding>,
}

/// Says that a structure is too small for the sheet, rather than that each of its parts is:
/// most often its unit was misread.
pub fn too_small(structure: &Structure, fit: &Fit) -> Option<PartFinding> {
    let mut lengths: Vec<f64> =
        structure.fins().iter().map(|&fin| structure.length(fin)).collect();
    lengths.sort_by(f64::total_cmp);
    let median_mm = (lengths.get(lengths.len() / 2)? * 100.0).round() / 100.0;
    let thickness_mm = fit.thickness;
    let size = structure.size_text();
    (median_mm < 2.0 * thickness_mm).then_some(PartFinding::ModelTooSmall {
        median_mm,
        thickness_mm,
        size,
    })
}

/// Makes the parts of a structure whose strips are half-lapped; the nodes `asked` get hubs,
/// and so do those where ends of strips cannot lap.
pub fn strips(structure: &Structure, asked: &[NodeId], making: &Making) -> Made {
    let plan = plan(structure, asked, making.fit);
    let Plan { structure, flat, joinery, hubs, findings } = &plan;
    let mut findings: Vec<Finding> =
        findings.iter().cloned().map(Finding::from).collect();
    let mut parts = Vec::new();
    for (rank, &strip) in joinery.order.iter().enumerate() {
        let name = joinery.names[strip].as_str();
        let (flat, joints) = (&flat[strip], &joinery.joints[strip]);
        let slitted =
            Slitted { name, strip: flat, slits: &joints.slits, fit: making.fit };
        findings.extend(strength::weaknesses(&slitted).into_iter().map(Finding::from));
        let whole = Whole { name, strip: flat, joints, fit: making.fit, hubs };
        let pieces = splice::pieces(&whole, making.fits).unwrap_or_else(|finding| {
            findings.push(finding.into());
            vec![whole.uncut()]
        });
        let seat = Seat { strip, rank, flat, making, name };
        parts.extend(seat.parts(pieces));
    }
    name_partners(&mut parts, &joinery.names);
    findings.extend(parts.iter().filter_map(crossing_outline).map(Finding::from));
    findings.extend(connector::discs(&plan, &mut parts, making));
    let structure = structure.clone();
    Made { steps: steps(&parts), structure, parts, findings }
}

/// A strip on its way to parts.
struct Seat<'a> {
    strip: usize,
    rank: usize,
    flat: &'a FlatStrip,
    making: &'a Making<'a>,
    name: &'a str,
}

impl Seat<'_> {
    fn parts(&self, pieces: Vec<Piece>) -> Vec<Part> {
        let count = pieces.len();
        let mut first = 0;
        let mut parts = Vec::new();
        for (k, piece) in pieces.into_iter().enumerate() {
            let id = match count {
                1 => self.name.to_owned(),
                _ => format!("{}{}", self.name, piece_letter(k)),
            };
            let axes = piece.axes.len();
            parts.push(self.part(id, piece, first));
            first += axes;
        }
        parts
    }

    fn part(&self, id: String, piece: Piece, first: usize) -> Part {
        let all = &self.flat.axes;
        let after = first + piece.axes.len();
        let inner = (first.max(1)..after.min(all.len() - 1)).map(|k| k - 1);
        let folds: Vec<Fold> = inner.map(|k| self.flat.folds[k]).collect();
        let splice = |k: usize| [all[k - 1].node, all[k].node];
        let left = (first > 0).then(|| splice(first));
        let right = (after < all.len()).then(|| splice(after));
        let marks = mark::marks(&piece, &id, &folds, self.making.marking);
        let outline = outline(&piece, self.making.fit);
        let body = StripBody {
            strip: self.strip,
            folds,
            slits: piece.slits.values().map(|slit| (*slit, String::new())).collect(),
            splices: left.into_iter().chain(right).collect(),
            closed: self.flat.closed && left.is_none() && right.is_none(),
            rank: self.rank,
            setbacks: [0, 1].map(|end| piece.closures[end].setback()),
            axes: piece.axes,
        };
        let region = Region { outline, holes: Vec::new() };
        Part { id, quantity: 1, region, marks, body: Body::Strip(body) }
    }
}

/// a, b, ... z, aa, ab, ...
fn piece_letter(k: usize) -> String {
    let letter = char::from(b'a' + (k % 26) as u8);
    if k < 26 {
        letter.to_string()
    } else {
        format!("{}{letter}", piece_letter(k / 26 - 1))
    }
}

/// Tells each slit which part comes into it: of a spliced strip, the piece at that node.
fn name_partners(parts: &mut [Part], names: &[String]) {
    let mut at: BTreeMap<(usize, NodeId), String> = BTreeMap::new();
    for part in parts.iter() {
        let Body::Strip(body) = &part.body else { continue };
        at.extend(
            body.slits.iter().map(|(s, _)| ((body.strip, s.node), part.id.clone())),
        );
    }
    for part in parts {
        let Body::Strip(body) = &mut part.body else { continue };
        for (slit, partner) in &mut body.slits {
            let piece = at.get(&(slit.partner, slit.node));
            *partner = piece.unwrap_or(&names[slit.partner]).clone();
        }
    }
}

/// Strips that bend more tightly while they are put in than a model should.
pub fn tight_insertions(
    structure: &Structure,
    parts: &[Part],
    fit: &Fit,
) -> Vec<PartFinding> {
    let tight = parts.iter().filter_map(|part| {
        let Body::Strip(body) = &part.body else { return None };
        let (radius_mm, node) = insertion(structure, body, fit.clearance)?.bend?;
        let ratio = radius_mm / fit.thickness;
        let (part, limit) = (part.id.clone(), fit.bend_model);
        (ratio < limit).then_some(PartFinding::InsertionTight {
            part,
            node,
            radius_mm,
            ratio,
            limit,
        })
    });
    tight.collect()
}

fn crossing_outline(part: &Part) -> Option<PartFinding> {
    let simple = predicates::is_simple(&part.region.outline.flattened(ARC_SAGITTA_MM));
    let node = *part.body.nodes().first()?;
    (!simple).then(|| PartFinding::OutlineCrossesItself { part: part.id.clone(), node })
}
