//! Whether connectors have room: between fins, along fins, along the axis, on the sheet.

use crate::geometry::Point2;
use crate::parts::Making;
use crate::parts::connector::finding::ConnectorFinding;
use crate::parts::connector::hinge::Hinge;
use crate::parts::connector::seat::Hub;
use crate::parts::connector::spoke::{Around, sectors, shortest};
use crate::parts::connector::{Connector, disc};
use crate::structure::Structure;
use crate::tolerance::{ARC_SAGITTA_MM, SAME_LENGTH_MM};

/// Most of a fin that setbacks may take before it is said.
const SETBACK_SHARE: f64 = 0.25;

pub(super) fn findings(
    structure: &Structure,
    making: &Making,
    connectors: &[Option<Connector>],
    names: &[String],
) -> Vec<ConnectorFinding> {
    let mut all = Vec::new();
    for connector in connectors.iter().flatten() {
        all.extend(sharp(connector, making, names));
        match connector {
            Connector::Hub(hub) => {
                all.extend(short(making, hub).into_iter().chain(large(making, hub)));
            }
            Connector::Hinge(hinge) => all.extend(stacked(making, hinge)),
        }
    }
    let rooms: Vec<Room> = names
        .iter()
        .enumerate()
        .map(|(fin, name)| Room::new(structure, connectors, (fin, name)))
        .collect();
    all.extend(rooms.iter().filter_map(|room| room.touching(making)));
    all.extend(setbacks(making, &rooms));
    all
}

/// What is said of names that found no room, all at once: on a small model there are many.
pub(super) fn unlettered(missing: &[(String, usize)]) -> Option<ConnectorFinding> {
    let parts: Vec<String> =
        missing.iter().filter(|(_, n)| *n > 0).map(|(part, _)| part.clone()).collect();
    let count = missing.iter().map(|(_, count)| count).sum();
    (count > 0).then_some(ConnectorFinding::Unlettered { parts, count })
}

/// Fins too near each other for the web between their windows.
fn sharp(
    connector: &Connector,
    making: &Making,
    names: &[String],
) -> Vec<ConnectorFinding> {
    let least = making.fit.fin_angle_least;
    let Around { node, spokes, .. } = connector.around();
    let sharp =
        sectors(spokes).into_iter().enumerate().filter(|&(_, angle)| angle < least);
    sharp
        .map(|(place, angle)| {
            let next = (place + 1) % spokes.len();
            ConnectorFinding::AngleTooSmall {
                fins: [place, next].map(|k| names[spokes[k].fin].clone()),
                node: *node,
                angle_deg: angle.to_degrees(),
                setback_mm: connector.setback(),
                least_deg: least.to_degrees(),
            }
        })
        .collect()
}

/// An axis on which two discs have no room.
fn short(making: &Making, hub: &Hub) -> Option<ConnectorFinding> {
    let [low, high] = hub.between();
    let web_mm = high - low - 2.0 * making.fit.relief;
    let least_mm = making.fit.web;
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
fn stacked(making: &Making, hinge: &Hinge) -> Option<ConnectorFinding> {
    let [below, above] = hinge.around.reach;
    let (height_mm, needed_mm) = (below + above, hinge.needed(making.fit));
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
    nodes: [usize; 2],
    length: f64,
    /// What they take with their plates, and what the fin is cut back by.
    taken: f64,
    lost: f64,
}

impl Room {
    fn new(
        structure: &Structure,
        connectors: &[Option<Connector>],
        (fin, name): (usize, &str),
    ) -> Self {
        let nodes = structure.fins()[fin];
        let sum = |of: fn(&Connector) -> f64| {
            nodes.iter().filter_map(|&node| connectors[node].as_ref()).map(of).sum()
        };
        let (taken, lost) = (sum(Connector::reach), sum(Connector::setback));
        Self {
            part: name.to_owned(),
            nodes,
            length: shortest(structure, nodes),
            taken,
            lost,
        }
    }

    fn touching(&self, making: &Making) -> Option<ConnectorFinding> {
        let least_mm = making.fit.web_least;
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
fn setbacks(making: &Making, rooms: &[Room]) -> Option<ConnectorFinding> {
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
        thinner_mm: making.fit.thickness / grow,
    })
}
