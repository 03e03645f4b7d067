//! Whether connectors have room: between fins, along fins, along the axis, on the sheet.

use crate::geometry::Point2;
use crate::ids::NodeId;
use crate::parts::Making;
use crate::parts::connector::{Connector, Holding};
use crate::parts::finding::ConnectorFinding;
use crate::parts::fit::Fit;
use crate::parts::hinge::plate::Hinge;
use crate::parts::hub::dimensions::Hub;
use crate::parts::hub::disc;
use crate::parts::star::{Around, Spoke, sectors, shortest};
use crate::structure::Structure;
use crate::tolerance::{ARC_SAGITTA_MM, SAME_LENGTH_MM};

/// Most of a fin that setbacks may take before it is said.
const SETBACK_SHARE: f64 = 0.25;

pub(crate) fn findings(holding: &Holding) -> Vec<ConnectorFinding> {
    let (making, fit) = (holding.making, holding.making.fit);
    let name = |fin: usize| holding.names[fin].clone();
    let mut all = Vec::new();
    for connector in holding.connectors.iter().flatten() {
        all.extend(sharp(connector.around(), connector.setback(), &name, fit));
        match connector {
            Connector::Hub(hub) => {
                all.extend(short(fit, hub).into_iter().chain(large(making, hub)));
            }
            Connector::Hinge(hinge) => all.extend(stacked(fit, hinge)),
        }
    }
    let rooms: Vec<Room> =
        (0..holding.names.len()).filter_map(|fin| Room::new(holding, fin)).collect();
    all.extend(rooms.iter().filter_map(|room| room.touching(fit)));
    all.extend(setbacks(fit, &rooms));
    all
}

/// Why a hub has no room, if so; `taken` is what cuts take at the other end of the fin to a
/// node, mm.
pub(crate) fn hub_lacks(
    structure: &Structure,
    hub: &Hub,
    taken: &dyn Fn(NodeId) -> f64,
    fit: &Fit,
) -> Option<ConnectorFinding> {
    let nodes = |fin: usize| structure.fins()[fin].ends();
    let name = |fin: usize| format!("fin {}", structure.fins()[fin]);
    let touching = |spoke: &Spoke| {
        let room = Room {
            part: name(spoke.fin),
            nodes: nodes(spoke.fin),
            length: shortest(structure, nodes(spoke.fin)),
            taken: hub.notch[1] + taken(spoke.to),
            lost: hub.setback,
        };
        room.touching(fit)
    };
    sharp(&hub.around, hub.setback, &name, fit)
        .into_iter()
        .next()
        .or_else(|| short(fit, hub))
        .or_else(|| hub.around.spokes.iter().find_map(touching))
}

/// What is said of names that found no room, all at once: on a small model there are many.
pub(crate) fn unlettered(missing: &[(String, usize)]) -> Option<ConnectorFinding> {
    let parts: Vec<String> =
        missing.iter().filter(|(_, n)| *n > 0).map(|(part, _)| part.clone()).collect();
    let count = missing.iter().map(|(_, count)| count).sum();
    (count > 0).then_some(ConnectorFinding::Unlettered { parts, count })
}

/// Fins too near each other for the web between their windows.
fn sharp(
    around: &Around,
    setback_mm: f64,
    name: &dyn Fn(usize) -> String,
    fit: &Fit,
) -> Vec<ConnectorFinding> {
    let least = fit.fin_angle_least;
    let Around { node, spokes, .. } = around;
    let sharp =
        sectors(spokes).into_iter().enumerate().filter(|&(_, angle)| angle < least);
    sharp
        .map(|(place, angle)| {
            let next = (place + 1) % spokes.len();
            ConnectorFinding::AngleTooSmall {
                fins: [place, next].map(|k| name(spokes[k].fin)),
                node: *node,
                angle_deg: angle.to_degrees(),
                setback_mm,
                least_deg: least.to_degrees(),
            }
        })
        .collect()
}

/// An axis on which two discs have no room.
fn short(fit: &Fit, hub: &Hub) -> Option<ConnectorFinding> {
    let [low, high] = hub.between();
    let web_mm = high - low - 2.0 * fit.relief;
    let least_mm = fit.web;
    let [below, above] = hub.around.reach;
    let height_mm = below + above;
    let needed_mm = height_mm + (least_mm - web_mm);
    (web_mm < least_mm).then_some(ConnectorFinding::AxisTooShort {
        node: hub.around.node,
        height_mm,
        plates: 2,
        needed_mm,
    })
}

/// An axis on which the plates of all fins have no room.
fn stacked(fit: &Fit, hinge: &Hinge) -> Option<ConnectorFinding> {
    let [below, above] = hinge.around.reach;
    let (height_mm, needed_mm) = (below + above, hinge.needed(fit));
    (needed_mm > height_mm).then_some(ConnectorFinding::AxisTooShort {
        node: hinge.around.node,
        height_mm,
        plates: 2 * hinge.around.spokes.len(),
        needed_mm,
    })
}

/// Discs that fit no sheet.
fn large(making: &Making, hub: &Hub) -> Option<ConnectorFinding> {
    let outline = disc::circle(Point2::origin(), hub.radius).flattened(ARC_SAGITTA_MM);
    let angle = hub.sectors().into_iter().fold(f64::INFINITY, f64::min);
    (!(making.fits)(&outline)).then_some(ConnectorFinding::DiscTooLarge {
        node: hub.around.node,
        diameter_mm: 2.0 * hub.radius,
        angle_deg: angle.to_degrees(),
    })
}

/// What connectors leave of one fin.
struct Room {
    part: String,
    nodes: [NodeId; 2],
    length: f64,
    /// What they take with their plates, and what the fin is cut back by.
    taken: f64,
    lost: f64,
}

impl Room {
    /// `None` for a fin that no connector holds.
    fn new(holding: &Holding, fin: usize) -> Option<Self> {
        let nodes = holding.structure.fins()[fin].ends();
        let held = || nodes.iter().filter_map(|&node| holding.connectors[node].as_ref());
        held().next()?;
        let slit = |at: [NodeId; 2]| holding.slits.get(&at).copied().unwrap_or_default();
        let slits = slit(nodes) + slit([nodes[1], nodes[0]]);
        Some(Self {
            part: holding.names[fin].clone(),
            nodes,
            length: shortest(holding.structure, nodes),
            taken: held().map(Connector::reach).sum::<f64>() + slits,
            lost: held().map(Connector::setback).sum(),
        })
    }

    fn touching(&self, fit: &Fit) -> Option<ConnectorFinding> {
        let least_mm = fit.web_least;
        let web_mm = self.length - self.taken;
        (web_mm < least_mm - SAME_LENGTH_MM).then(|| ConnectorFinding::Touch {
            part: self.part.clone(),
            nodes: self.nodes,
            length_mm: self.length,
            web_mm,
            least_mm,
            grow: (self.taken + least_mm) / self.length,
        })
    }

    fn lost_share(&self) -> f64 {
        self.lost / self.length
    }
}

/// Fins that lose more than a quarter, told by the worst.
fn setbacks(fit: &Fit, rooms: &[Room]) -> Option<ConnectorFinding> {
    let short = || rooms.iter().filter(|room| room.lost_share() > SETBACK_SHARE);
    let worst = short().max_by(|a, b| a.lost_share().total_cmp(&b.lost_share()))?;
    let grow = worst.lost_share() / SETBACK_SHARE;
    Some(ConnectorFinding::SetbackTooLong {
        part: worst.part.clone(),
        nodes: worst.nodes,
        count: short().count(),
        length_mm: worst.length,
        lost_mm: worst.lost,
        grow,
        thinner_mm: fit.thickness / grow,
    })
}
