//! A *hub*: two slotted discs that hold the fins of a node.
//!
//! One shape, pushed onto the fins of a node along its axis, one from below and one from
//! above, a rod through both. A window crosses its fin squarely, so its width is the thickness
//! and the clearance at any angle, and the disc is its own angle gauge (`docs/connectors.md`).

pub(super) mod checks;
pub(super) mod dimensions;
mod disc;
pub(super) mod tenon;

pub use dimensions::inner_radius;

use crate::geometry::{Region, Vertex};
use crate::ids::NodeId;
use crate::parts::connector::{Connector, PlateText, Writable};
use crate::parts::end::EndFrame;
use crate::parts::finding::PartFinding;
use crate::parts::fit::Fit;
use crate::parts::mark::Mark;
use crate::parts::plan::Plan;
use crate::parts::plate::{PlacedPlate, PlateForm, Plates};
use crate::parts::star::{IncidentFin, Star};
use crate::parts::{Making, fin};
use crate::structure::Structure;
use dimensions::Hub;

/// Single fins in hubs on all nodes.
pub(super) fn plan(structure: &Structure, _asked: &[NodeId], fit: &Fit) -> Plan {
    fin::plan(structure, fit, &|star| Box::new(Hub::new(star, fit)))
}

impl Connector for Hub {
    fn star(&self) -> &Star {
        &self.star
    }

    fn plates(&self) -> Plates {
        let half = self.thickness / 2.0;
        let holds: Vec<usize> = (0..self.star.fins.len()).collect();
        let placed = |height| PlacedPlate { height, bearing: 0.0, holds: holds.clone() };
        Plates {
            form: PlateForm::Disc { radius: self.radius },
            thickness: self.thickness,
            hole: self.hole,
            slot: [self.width, self.slot],
            copies: [self.faces[0] + half, self.faces[1] - half].map(placed).to_vec(),
            laid_first: 1,
        }
    }

    fn setback(&self) -> f64 {
        self.setback
    }

    fn reach(&self) -> f64 {
        self.notch[1]
    }

    /// A plate with play in a window turns as if a pin at the window's length held it.
    fn moment_arm(&self) -> Option<f64> {
        Some(self.slot)
    }

    fn fin_end(&self, frame: &EndFrame, _fin: &IncidentFin, fit: &Fit) -> Vec<Vertex> {
        tenon::tenon(frame, self, fit.relief)
    }

    /// The line to the other end must stay clear of the notch however it slopes.
    fn writable(&self, fin: &IncidentFin, fit: &Fit) -> Writable {
        let [low, high] = self.between();
        let spare = |edge: usize| fit.relief + fin.rise[edge].abs() * self.radius;
        let heights = Some([low + spare(0), high - spare(1)]);
        Writable { from: self.setback, heights }
    }

    fn region(&self, fit: &Fit) -> Region {
        disc::region(self, fit)
    }

    fn marks(&self, text: &PlateText, fit: &Fit) -> (Vec<Mark>, usize) {
        disc::marks(self, fit, text)
    }

    fn lacks(&self, making: &Making) -> Vec<PartFinding> {
        let short = checks::short_axis(self, making.fit);
        short.into_iter().chain(checks::large_discs(self, making)).collect()
    }

    fn words(&self, name: &str) -> String {
        format!(
            "One disc {name} lies below, its letters up: set the fins into its windows as they \
             are lettered, push the other disc on from above, its letters up too, and bolt the rod."
        )
    }
}
