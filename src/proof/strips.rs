//! The strips of one format's files: measured, refolded, compared with the structure.

use crate::geometry::Point2;
use crate::manifest::{Manifest, RunEntry, SlitEntry, Worst};
use crate::proof::Limits;
use crate::proof::figures::{NodeFigure, SlitFigure, micro};
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::fit;
use crate::proof::measure::{FlatAxis, Measured, Notch, measure};
use crate::proof::refold::{Meetings, folded, placed, targets};
use crate::proof::sheets::Read;
use crate::structure::Structure;
use std::collections::BTreeMap;

/// A strip found in the files.
struct Drawn<'a> {
    id: &'a str,
    strip: &'a RunEntry,
    measured: Measured,
    /// Axes as measured; where that was not possible, as listed.
    axes: Vec<FlatAxis>,
    /// Its outline as listed and as drawn.
    listed: &'a [Point2],
    outline: &'a crate::geometry::Contour,
    spot: Box<dyn Fn(Point2) -> Spot + 'a>,
}

/// What is known of the strips of a job.
pub(super) struct Strips<'a> {
    structure: &'a Structure,
    manifest: &'a Manifest,
    drawn: Vec<Drawn<'a>>,
    /// By node: strips (by index) with a slit there, and where along them.
    slit: BTreeMap<usize, Vec<(usize, usize)>>,
}

/// What came out.
#[derive(Default)]
pub(super) struct Refolded {
    pub findings: Vec<ProofFinding>,
    pub nodes: Vec<NodeFigure>,
    pub slits: Vec<SlitFigure>,
}

/// Measures and refolds the strips that were found; figures go into `worst` too.
pub(super) fn refold(read: &Read, structure: &Structure, worst: &mut Worst) -> Refolded {
    let (strips, mut findings) = Strips::new(read, structure);
    let mut out = Refolded::default();
    worst.slit_play_least_mm = f64::INFINITY;
    for index in 0..strips.drawn.len() {
        findings.extend(strips.slits(index, &mut out.slits));
        findings.extend(strips.folds(index));
        findings.extend(strips.fins(index, worst));
        findings.extend(strips.ends(index));
    }
    findings.extend(strips.without_slit());
    for slit in &out.slits {
        worst.slit_off_mm = worst.slit_off_mm.max(slit.off_mm.abs());
        worst.slit_play_least_mm = worst.slit_play_least_mm.min(slit.play_mm);
        worst.slit_play_most_mm = worst.slit_play_most_mm.max(slit.play_mm);
    }
    if out.slits.is_empty() {
        worst.slit_play_least_mm = 0.0;
    }
    let (nodes, gaps) = strips.nodes(worst);
    let blamed: Vec<String> =
        findings.iter().flat_map(|f| f.spot().parts.clone()).collect();
    // A wrong fold or fin opens gaps at every node of its strip: the cause is enough.
    findings.extend(
        gaps.into_iter()
            .filter(|gap| gap.spot().parts.iter().all(|part| !blamed.contains(part))),
    );
    Refolded { findings, nodes, ..out }
}

impl<'a> Strips<'a> {
    fn new(read: &'a Read, structure: &'a Structure) -> (Self, Vec<ProofFinding>) {
        let mut findings = Vec::new();
        let mut drawn = Vec::new();
        for found in &read.found {
            let place = &read.matching.places[found.place];
            let part = read.matching.shapes[place.shape].part;
            let Some(strip) = part.run() else { continue };
            let file = read.file(found);
            if !strip.is_sound(structure.nodes().len()) {
                let spot = Spot::file("job.json").part(&part.id);
                findings.push(ProofFinding::BadList { spot });
                continue;
            }
            let measured = measure(strip, &part.outline, &found.outline);
            let axes = strip.axes.iter().zip(&measured.axes);
            let axes = axes.map(|(l, axis)| axis.unwrap_or([l.bottom, l.top])).collect();
            let motion = found.motion;
            let spot =
                move |p: Point2| Spot::file(file).part(&part.id).at(motion.apply(p));
            let outline = &found.outline;
            let spot = Box::new(spot);
            let listed = part.outline.as_slice();
            drawn.push(Drawn {
                id: &part.id,
                strip,
                measured,
                axes,
                listed,
                outline,
                spot,
            });
        }
        let mut slit: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (index, strip) in drawn.iter().enumerate() {
            for &(place, _) in &strip.measured.slits {
                slit.entry(strip.strip.nodes[place]).or_default().push((index, place));
            }
        }
        (Self { structure, manifest: read.manifest, drawn, slit }, findings)
    }

    fn limits(&self) -> &Limits {
        &self.manifest.proof.limits
    }

    /// The strip that comes into a slit, if it was found.
    fn partner(&self, index: usize, node: usize) -> Option<(usize, usize)> {
        self.slit.get(&node)?.iter().find(|(other, _)| *other != index).copied()
    }

    fn arms(&self, (index, place): (usize, usize)) -> Option<[f64; 2]> {
        let strip = self.drawn[index].strip;
        fit::arms(self.structure, strip.nodes[place], strip.beside(place))
    }

    /// Half-widths needed by the slit of a strip; as listed where its partner is unknown.
    fn needed(&self, at: (usize, usize), slit: &SlitEntry) -> [f64; 2] {
        let listed = || {
            let half = (slit.width - self.manifest.material.clearance) / 2.0;
            [half - slit.offset, half + slit.offset]
        };
        let angles = || {
            let partner = self.partner(at.0, slit.node)?;
            Some((self.arms(at)?, self.arms(partner)?))
        };
        angles().map_or_else(listed, |(own, other)| {
            fit::needed(own, other, self.manifest.material.thickness)
        })
    }

    fn slits(&self, index: usize, figures: &mut Vec<SlitFigure>) -> Vec<ProofFinding> {
        let drawn = &self.drawn[index];
        let mut findings = Vec::new();
        for &(place, notch) in &drawn.measured.slits {
            let Some(slit) = drawn.strip.slit_at(place) else { continue };
            let axis = drawn.axes[place];
            let Some(notch) = notch else {
                let spot =
                    (drawn.spot)(nalgebra::center(&axis[0], &axis[1])).node(slit.node);
                let partner = slit.partner.clone();
                findings.push(ProofFinding::SlitMissing { spot, partner });
                continue;
            };
            let needed = self.needed((index, place), slit);
            let partner = self.partner(index, slit.node);
            let other = partner.and_then(|(other, place)| {
                let slits = &self.drawn[other].measured.slits;
                slits.iter().find(|(at, _)| *at == place).and_then(|(_, notch)| *notch)
            });
            let height = self.structure.nodes()[slit.node].height();
            let figure = SlitFigure {
                part: drawn.id.to_owned(),
                node: slit.node,
                partner: slit.partner.clone(),
                width_mm: micro(notch.before + notch.after),
                depth_mm: micro(notch.depth),
                off_mm: micro((notch.after - notch.before - needed[1] + needed[0]) / 2.0),
                play_mm: micro(notch.before + notch.after - needed[0] - needed[1]),
                reach_mm: other.map(|other| micro(notch.depth + other.depth - height)),
            };
            let spot = (drawn.spot)(notch.at).node(slit.node);
            findings.extend(self.slit_findings(&figure, slit, &notch, &spot));
            figures.push(figure);
        }
        findings
    }

    fn slit_findings(
        &self,
        figure: &SlitFigure,
        slit: &SlitEntry,
        notch: &Notch,
        spot: &Spot,
    ) -> Vec<ProofFinding> {
        let material = &self.manifest.material;
        let (width_mm, play_mm) = (figure.width_mm, figure.play_mm);
        let clearance_mm = material.clearance;
        let mut findings = Vec::new();
        let here = || spot.clone();
        if figure.off_mm.abs() > self.limits().axes_and_slits_mm {
            findings.push(ProofFinding::SlitMoved { spot: here(), by_mm: figure.off_mm });
        }
        if play_mm < clearance_mm - self.limits().axes_and_slits_mm {
            let spot = here();
            findings.push(ProofFinding::SlitNarrow {
                spot,
                width_mm,
                play_mm,
                clearance_mm,
            });
        } else if play_mm > clearance_mm + self.limits().axes_and_slits_mm {
            let spot = here();
            findings.push(ProofFinding::SlitWide {
                spot,
                width_mm,
                play_mm,
                clearance_mm,
            });
        }
        // Each pair is told of once, by the part whose slit differs from its list.
        let deeper = notch.depth - slit.depth;
        let lost_round = material.kerf.abs() / 2.0;
        let reach = figure.reach_mm.unwrap_or(0.0);
        if reach < 0.0 && deeper < -self.limits().axes_and_slits_mm {
            findings.push(ProofFinding::SlitShort { spot: here(), short_mm: -reach });
        } else if deeper < -self.limits().axes_and_slits_mm
            || deeper > self.limits().axes_and_slits_mm + lost_round
        {
            let (depth_mm, listed_mm) = (figure.depth_mm, slit.depth);
            findings.push(ProofFinding::SlitDepth { spot: here(), depth_mm, listed_mm });
        }
        findings
    }

    /// Strips that run through one node, so that they cross, but have no slits there.
    fn without_slit(&self) -> Vec<ProofFinding> {
        let mut through: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (index, drawn) in self.drawn.iter().enumerate() {
            for place in 0..drawn.strip.nodes.len() {
                if drawn.strip.beside(place).iter().all(Option::is_some) {
                    through
                        .entry(drawn.strip.nodes[place])
                        .or_default()
                        .push((index, place));
                }
            }
        }
        let pairs = through.into_iter().filter(|(_, strips)| strips.len() == 2);
        let bare = pairs.flat_map(|(node, strips)| {
            [[0, 1], [1, 0]].map(|[own, other]| (node, strips[own], strips[other]))
        });
        bare.filter(|(_, (index, place), _)| {
            self.drawn[*index].strip.slit_at(*place).is_none()
        })
        .map(|(node, (index, place), (other, _))| {
            let drawn = &self.drawn[index];
            let spot = (drawn.spot)(drawn.axes[place][0]).node(node);
            ProofFinding::SlitMissing { spot, partner: self.drawn[other].id.to_owned() }
        })
        .collect()
    }

    fn folds(&self, index: usize) -> Vec<ProofFinding> {
        let Drawn { strip, id, .. } = &self.drawn[index];
        let places = 0..strip.nodes.len();
        let wrong = places.filter_map(|place| {
            let [before, after] = strip.beside(place);
            let node = strip.nodes[place];
            let has_both =
                |to: usize| self.structure.nodes()[node].arm(to.into()).is_some();
            let (before, after) =
                (before.filter(|n| has_both(*n))?, after.filter(|n| has_both(*n))?);
            let needed_deg = self
                .structure
                .fold(before.into(), node.into(), after.into())
                .to_degrees();
            let listed = strip.folds().iter().find(|fold| fold.node == node);
            let listed_deg = listed.map_or(0.0, |fold| fold.angle_deg);
            let spot = Spot::file("job.json").part(id).node(node);
            ((listed_deg - needed_deg).abs() > self.limits().folds_deg)
                .then_some(ProofFinding::FoldWrong { spot, listed_deg, needed_deg })
        });
        wrong.collect()
    }

    /// Fins whose corners are not as far apart as in the structure.
    fn fins(&self, index: usize, worst: &mut Worst) -> Vec<ProofFinding> {
        let drawn = &self.drawn[index];
        let targets = targets(self.structure, drawn.strip);
        let mut findings = Vec::new();
        for place in 1..drawn.axes.len() {
            let [a, b] = [drawn.axes[place - 1], drawn.axes[place]];
            let [c, d] = [targets[place - 1], targets[place]];
            let flat = [a[0], a[1], b[0], b[1]];
            let space = [c[0], c[1], d[0], d[1]];
            let pairs = (0..4).flat_map(|i| (0..i).map(move |j| (i, j)));
            let by_mm = pairs
                .map(|(i, j)| (flat[i] - flat[j]).norm() - (space[i] - space[j]).norm())
                .fold(0.0, |worst: f64, off| worst.max(off.abs()));
            worst.fin_mm = worst.fin_mm.max(micro(by_mm));
            if by_mm > self.limits().axes_and_slits_mm {
                let [node, to] = [place - 1, place].map(|k| drawn.strip.nodes[k]);
                let spot = (drawn.spot)(nalgebra::center(&a[0], &b[1])).node(node);
                findings.push(ProofFinding::FinDiffers { spot, to, by_mm });
            }
        }
        findings
    }

    /// Ends without a slit that reach into the plates beside them.
    fn ends(&self, index: usize) -> Vec<ProofFinding> {
        let drawn = &self.drawn[index];
        let last = drawn.axes.len() - 1;
        let ends = [(0, 1.0), (last, -1.0)];
        ends.into_iter().filter_map(|(place, way)| self.end(drawn, place, way)).collect()
    }

    fn end(&self, drawn: &Drawn, place: usize, way: f64) -> Option<ProofFinding> {
        let strip = drawn.strip;
        let node = strip.nodes[place];
        let inner = match strip.beside(place) {
            [Some(inner), None] | [None, Some(inner)] => inner,
            // Over a splice the strip runs on.
            _ => return None,
        };
        let held = self.slit.get(&node).is_some_and(|slits| {
            slits.iter().any(|(other, _)| std::ptr::eq(&self.drawn[*other], drawn))
        });
        let arms = &self.structure.nodes()[node].arms;
        let bearing = |to: usize| fit::bearing(self.structure, node, to);
        self.structure.nodes()[node].arm(inner.into())?;
        if held || arms.len() < 2 {
            return None;
        }
        let others = arms.iter().filter(|arm| arm.to.index() != inner);
        let thickness = self.manifest.material.thickness;
        let needed_mm = others
            .map(|arm| {
                let angle = fit::between(bearing(inner), bearing(arm.to.index()));
                fit::reach(angle, thickness)
            })
            .fold(0.0, f64::max);
        let [bottom, top] = [strip.axes[place].bottom, strip.axes[place].top];
        let up = (top - bottom).try_normalize(0.0)?;
        let inward = crate::geometry::Vector2::new(up.y, -up.x) * way;
        let corner = |end: Point2| {
            let off = |p: &&Point2| (**p - end).norm();
            // On this side of the axis: the other end of a ring may lie on that one.
            let own = drawn.listed.iter().filter(|p| (**p - end).dot(&inward) >= 0.0);
            let listed = own.min_by(|a, b| off(a).total_cmp(&off(b)))?;
            let off = |p: &Point2| (p - listed).norm();
            let corners = drawn.outline.vertices.iter().map(|vertex| vertex.point);
            corners.min_by(|a, b| off(a).total_cmp(&off(b)))
        };
        let corners = [corner(bottom)?, corner(top)?];
        let distance_mm = corners
            .map(|corner| (corner - bottom).dot(&inward))
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let spot = (drawn.spot)(bottom).node(node);
        let limit = self.limits().axes_and_slits_mm;
        let listed = strip.setbacks[usize::from(place > 0)];
        if distance_mm < needed_mm - limit {
            Some(ProofFinding::EndInTheWay { spot, distance_mm, needed_mm })
        } else {
            ((distance_mm - listed).abs() > limit)
                .then_some(ProofFinding::BadList { spot })
        }
    }

    /// Where the axes of all strips come to lie in space.
    fn nodes(&self, worst: &mut Worst) -> (Vec<NodeFigure>, Vec<ProofFinding>) {
        let mut meetings = Meetings::new();
        for drawn in &self.drawn {
            let axes = folded(drawn.strip, &drawn.axes);
            let axes = placed(&axes, &targets(self.structure, drawn.strip));
            for (node, axis) in drawn.strip.nodes.iter().zip(axes) {
                let meeting = meetings.entry(*node).or_default();
                meeting.parts.push((drawn.id.to_owned(), axis));
            }
        }
        let mut figures = Vec::new();
        let mut findings = Vec::new();
        for (node, meeting) in meetings {
            let at = &self.structure.nodes()[node];
            let off_mm = micro(meeting.off(&[at.bottom(), at.top()]));
            let gap_mm = micro(meeting.gap());
            let parts: Vec<String> =
                meeting.parts.into_iter().map(|(id, _)| id).collect();
            worst.node_gap_mm = worst.node_gap_mm.max(gap_mm);
            worst.node_off_mm = worst.node_off_mm.max(off_mm);
            if gap_mm.max(off_mm) > self.limits().axes_and_slits_mm {
                let spot =
                    Spot { parts: parts.clone(), ..Spot::file("job.json").node(node) };
                findings.push(ProofFinding::NodeGap { spot, gap_mm: gap_mm.max(off_mm) });
            }
            figures.push(NodeFigure { node, parts, gap_mm, off_mm });
        }
        (figures, findings)
    }
}
