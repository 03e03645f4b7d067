//! The structure as numbers for the 3D view of the page.

use crate::fabrication::Fabrication;
use crate::geometry::{Point3, Vector3};
use crate::ids::{FinId, NodeId, PartId};
use crate::joint::Joint;
use crate::parts::{Body, bends};
use crate::report::{fins, steps};
use crate::rigidity::Paper;
use crate::structure::{Structure, planarity};
use crate::template::Template;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// What the page's script needs to know.
pub(super) fn scene(
    job: &Fabrication,
    structure: &Structure,
    joint: Joint,
    template: &Template,
) -> Value {
    let order = order(job, template);
    let mut places = vec![0; order.len()];
    order.iter().enumerate().for_each(|(place, &part)| places[part] = place);
    let parts = fins::parts(job);
    let paper = job.verdict.as_ref().and_then(|verdict| verdict.paper());
    let gaps = paper.map(discrepancies);
    let rows = Rows { structure, paper, gaps, bends: tightness(job, template) };
    let bodies = bodies(structure, joint);
    let fins = structure.fins().iter().zip(&bodies).map(|(&fin, body)| {
        let part = parts.get(&fin).copied();
        rows.fin(fin.ends(), *body, part.map(|part| (part, places[part])))
    });
    let sheets = fins::sheets(job);
    let part = |&id: &PartId| json!({"id": job.parts[id].id, "sheet": sheets.get(&id)});
    let plates = job.parts_with_ids().flat_map(|(id, part)| {
        let node = part.body.nodes().first().map_or(0, |node| node.index());
        let place = places[id];
        fins::plates(structure, part).into_iter().map(move |corners| {
            let head = [json!(place), json!(node)];
            json!(
                head.into_iter()
                    .chain(points(&corners).into_iter().map(|x| json!(x)))
                    .collect::<Vec<_>>()
            )
        })
    });
    json!({
        "nodes": structure.nodes().iter().map(|node| {
            points(&[node.bottom(), node.top()])
        }).collect::<Vec<_>>(),
        "fixed": structure.fixed(),
        "fins": fins.collect::<Vec<_>>(),
        "motion": rows.motion(&bodies),
        "plates": plates.collect::<Vec<_>>(),
        "parts": order.iter().map(part).collect::<Vec<_>>(),
        "planarity_limit": template.gate.planarity_limit_percent,
        "bend_model": template.bend.model,
    })
}

/// The parts in the order of assembly; of a step its connector last.
fn order(job: &Fabrication, template: &Template) -> Vec<PartId> {
    let steps = steps::steps(job, template);
    let mut order: Vec<PartId> =
        steps.into_iter().flat_map(|step| step.parts.into_iter().rev()).collect();
    let known: BTreeSet<PartId> = order.iter().copied().collect();
    order.extend(job.parts_with_ids().map(|(id, _)| id).filter(|id| !known.contains(id)));
    order
}

/// The largest discrepancy of each body at each node.
fn discrepancies(paper: &Paper) -> BTreeMap<(NodeId, usize), f64> {
    let mut all: BTreeMap<(NodeId, usize), f64> = BTreeMap::new();
    for d in &paper.discrepancies {
        for body in d.bodies {
            let most = all.entry((d.node, body)).or_default();
            *most = most.max(d.value);
        }
    }
    all
}

/// Thickness over bend radius by part and node.
fn tightness(job: &Fabrication, template: &Template) -> BTreeMap<(PartId, NodeId), f64> {
    let mut all = BTreeMap::new();
    for (id, part) in job.parts_with_ids() {
        let Body::Strip(body) = &part.body else { continue };
        let thickness = template.material.thickness_mm;
        all.extend(bends(body).into_iter().map(|(n, r)| ((id, n), thickness / r)));
    }
    all
}

/// The body of the model that each fin belongs to: a strip, or itself.
fn bodies(structure: &Structure, joint: Joint) -> Vec<Option<usize>> {
    if !joint.has_strips() {
        return (0..structure.fins().len()).map(Some).collect();
    }
    let mut of = BTreeMap::new();
    for (index, strip) in structure.strips().iter().enumerate() {
        of.extend(strip.steps().map(|step| (FinId::from(step), index)));
    }
    structure.fins().iter().map(|fin| of.get(fin).copied()).collect()
}

struct Rows<'a> {
    structure: &'a Structure,
    paper: Option<&'a Paper>,
    /// Largest discrepancy by node and body.
    gaps: Option<BTreeMap<(NodeId, usize), f64>>,
    bends: BTreeMap<(PartId, NodeId), f64>,
}

impl Rows<'_> {
    /// `[i, j, part, planarity %, discrepancy at i and j, tightness of the bend at i and j]`;
    /// the part is given by its index and its place in the order of assembly.
    fn fin(
        &self,
        [i, j]: [NodeId; 2],
        body: Option<usize>,
        part: Option<(PartId, usize)>,
    ) -> Value {
        let (off, diameter) = planarity(&self.structure.corners([i, j]));
        let bend = |node| {
            let key = part.map(|(part, _)| (part, node));
            key.and_then(|key| self.bends.get(&key)).copied().map_or(0.0, four)
        };
        let gap = |node| {
            let key = body.map(|body| (node, body));
            let all = self.gaps.as_ref();
            all.map(|gaps| key.and_then(|k| gaps.get(&k)).copied().map_or(0.0, four))
        };
        let part = part.map_or(-1, |(_, place)| place as i64);
        json!([
            i,
            j,
            part,
            four(100.0 * off / diameter),
            gap(i),
            gap(j),
            bend(i),
            bend(j)
        ])
    }

    /// How far the corners of each fin go in the softest motion, the fastest by 1: bottom
    /// and top of its first node, bottom and top of its second.
    fn motion(&self, bodies: &[Option<usize>]) -> Option<Vec<Value>> {
        let paper = self.paper?;
        let motion = paper.motions.first()?;
        let velocity = |body: usize, p: Point3| {
            let x = motion.twists[body];
            let spin = Vector3::new(x[0], x[1], x[2]);
            spin.cross(&(p.coords * paper.scale)) + Vector3::new(x[3], x[4], x[5])
        };
        let corners = self.structure.fins().iter().zip(bodies).map(|(fin, body)| {
            let [a, b] = fin.ends().map(|node| &self.structure.nodes()[node]);
            let corners = [a.bottom(), a.top(), b.bottom(), b.top()];
            corners.map(|p| body.map_or_else(Vector3::zeros, |body| velocity(body, p)))
        });
        let corners: Vec<[Vector3; 4]> = corners.collect();
        let speeds = corners.iter().flatten().map(Vector3::norm);
        let fastest = speeds.fold(0.0, f64::max);
        let moved = |fin: &[Vector3; 4]| {
            let lengths = fin.iter().flat_map(|v| [v.x, v.y, v.z]);
            json!(lengths.map(|x| four(x / fastest)).collect::<Vec<_>>())
        };
        (fastest > 0.0).then(|| corners.iter().map(moved).collect())
    }
}

fn points(points: &[Point3]) -> Vec<f64> {
    points.iter().flat_map(|p| [p.x, p.y, p.z]).map(|x| (x * 1e3).round() / 1e3).collect()
}

/// To four digits: a picture needs no more.
fn four(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(0.0)
}
