//! What holds the fins of a node: the face that every kind of connector shows.
//!
//! A folder such as `hub` or `hinge` says how large its plates are, how fins end in them,
//! what they look like, what is wrong with them and how they go together. Nothing outside of
//! the folder asks which kind a connector is. A node with one fin needs none.

use crate::geometry::{Region, Vertex};
use crate::ids::NodeId;
use crate::parts::Making;
use crate::parts::end::EndFrame;
use crate::parts::finding::PartFinding;
use crate::parts::fit::Fit;
use crate::parts::mark::Mark;
use crate::parts::plate::Plates;
use crate::parts::star::{IncidentFin, Star};
use std::collections::BTreeMap;
use std::fmt::Debug;

/// What holds the fins of a node, by plates across its axis. Lengths in mm, from the axis.
pub(crate) trait Connector: Debug {
    /// The node and its fins.
    fn star(&self) -> &Star;

    /// Its plates.
    fn plates(&self) -> Plates;

    /// Where fins stop.
    fn setback(&self) -> f64;

    /// How far it reaches along a fin.
    fn reach(&self) -> f64;

    /// How far out it holds fins against turning about the axis; `None` if they turn.
    fn moment_arm(&self) -> Option<f64>;

    /// An end of a fin, from the bottom edge over the end edge to the top edge.
    fn fin_end(&self, frame: &EndFrame, fin: &IncidentFin, fit: &Fit) -> Vec<Vertex>;

    /// What the cuts leave of that end to write on.
    fn writable(&self, fin: &IncidentFin, fit: &Fit) -> Writable;

    /// The shape of a plate: its origin on the axis, labelled face up.
    fn region(&self, fit: &Fit) -> Region;

    /// What is engraved on a plate, and how many of the texts found no room.
    fn marks(&self, text: &PlateText, fit: &Fit) -> (Vec<Mark>, usize);

    /// What its plates lack: room on the axis, a sheet that takes them.
    fn lacks(&self, making: &Making) -> Vec<PartFinding>;

    /// How plates of this name and the fins go together, in sentences.
    fn words(&self, name: &str) -> String;
}

/// What holds the fins of each node, if it joins any.
pub(crate) type Connectors = BTreeMap<NodeId, Box<dyn Connector>>;

/// What cuts leave of the end of a fin. Lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Writable {
    /// From the axis to the floor of the cuts in the end edge.
    pub from: f64,
    /// Heights along the axis between cuts in the bottom and the top edge, if there are such.
    pub heights: Option<[f64; 2]>,
}

/// What is to be engraved on a plate.
pub(crate) struct PlateText<'a> {
    /// The name of the part.
    pub name: &'a str,
    /// Names of the parts that it holds, in the order of its fins.
    pub fins: &'a [String],
    /// Height of capital letters, mm.
    pub height: f64,
}
