//! A *hinge*: eye plates across the node axis, two for each fin, on one rod.
//!
//! A plate laps with its fin: the fin has a slit in its end edge, the plate one in its tail,
//! and they are pushed into each other across the axis. Around the rod the plates of all
//! fins lie on each other in two stacks, one near each end of the axis, in the order of the
//! fins: no two meet, no fin slides along the rod, and each turns about it (the joint of the
//! paper's Figure 6).

mod dimensions;
mod plate;

use crate::geometry::{Region, Vertex};
use crate::ids::NodeId;
use crate::parts::connector::{Connector, PlateText, Writable};
use crate::parts::end::EndFrame;
use crate::parts::finding::PartFinding;
use crate::parts::fit::Fit;
use crate::parts::hub::dimensions::Hub;
use crate::parts::mark::Mark;
use crate::parts::plan::Plan;
use crate::parts::plate::{PlacedPlate, PlateForm, Plates};
use crate::parts::star::{IncidentFin, Star};
use crate::parts::{Making, fin};
use crate::structure::Structure;
use dimensions::Hinge;

/// Single fins in hubs on the nodes `asked`, on hinges elsewhere.
pub(super) fn plan(structure: &Structure, asked: &[NodeId], fit: &Fit) -> Plan {
    fin::plan(structure, fit, &|star| {
        if asked.contains(&star.node) {
            Box::new(Hub::new(star, fit))
        } else {
            Box::new(Hinge::new(star, fit))
        }
    })
}

impl Connector for Hinge {
    fn star(&self) -> &Star {
        &self.star
    }

    fn plates(&self) -> Plates {
        let stacks = [0, 1].into_iter();
        let copies = stacks.flat_map(|stack| {
            let fins = self.star.fins.iter().zip(&self.levels).enumerate();
            fins.map(move |(place, (fin, levels))| PlacedPlate {
                height: levels[stack],
                bearing: fin.bearing,
                holds: vec![place],
            })
        });
        Plates {
            form: PlateForm::Eye { radius: self.radius, tail: self.tail() },
            thickness: self.thickness,
            hole: self.hole,
            slot: [self.width, self.tail() - self.floor],
            copies: copies.collect(),
            laid_first: 0,
        }
    }

    fn setback(&self) -> f64 {
        self.setback
    }

    fn reach(&self) -> f64 {
        self.tail()
    }

    fn moment_arm(&self) -> Option<f64> {
        None
    }

    fn fin_end(&self, frame: &EndFrame, fin: &IncidentFin, fit: &Fit) -> Vec<Vertex> {
        plate::slits(self, frame, fin, fit)
    }

    fn writable(&self, _fin: &IncidentFin, fit: &Fit) -> Writable {
        Writable { from: self.setback + self.lap + fit.relief, heights: None }
    }

    fn region(&self, fit: &Fit) -> Region {
        plate::region(self, fit)
    }

    fn marks(&self, text: &PlateText, _fit: &Fit) -> (Vec<Mark>, usize) {
        let mark = plate::mark(self, text);
        let missing = usize::from(mark.is_none());
        (mark.into_iter().collect(), missing)
    }

    /// An axis on which the plates of all fins have no room.
    fn lacks(&self, making: &Making) -> Vec<PartFinding> {
        let [below, above] = self.star.reach;
        let (height_mm, needed_mm) = (below + above, self.needed(making.fit));
        let lack = (needed_mm > height_mm).then_some(PartFinding::AxisTooShort {
            node: self.star.node,
            height_mm,
            plates: 2 * self.star.fins.len(),
            needed_mm,
        });
        lack.into_iter().collect()
    }

    fn words(&self, name: &str) -> String {
        format!(
            "Push plates {name} into the end slits of the fins and glue them; lay the fins \
             about the node in the order of job.json and slide the rod through all eyes."
        )
    }
}
