//! Fins in one piece: where node axes lie on it, how it folds, what is slit into it.

use crate::geometry::Point2;
use crate::manifest::points;
use serde::{Deserialize, Serialize};

/// Fins in one piece, one after the other; a single fin has no more than nodes, axes and
/// setbacks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RunEntry {
    /// Its nodes in order; of a closed run the first is also the last.
    pub nodes: Vec<usize>,
    /// Where the node axes lie on it.
    pub axes: Vec<AxisEntry>,
    /// How far it stops from its first and last axis, mm.
    #[serde(default)]
    pub setbacks: [f64; 2],
    /// Whether it is a ring.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closed: Option<bool>,
    /// How it folds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub folds: Option<Vec<FoldEntry>>,
    /// What is slit into it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slits: Option<Vec<SlitEntry>>,
    /// Fins in which it was parted from the next part of its strip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub splices: Option<Vec<SpliceEntry>>,
}

impl RunEntry {
    /// Whether it is a ring.
    pub fn is_closed(&self) -> bool {
        self.closed == Some(true)
    }

    /// How it folds.
    pub fn folds(&self) -> &[FoldEntry] {
        self.folds.as_deref().unwrap_or_default()
    }

    /// What is slit into it.
    pub fn slits(&self) -> &[SlitEntry] {
        self.slits.as_deref().unwrap_or_default()
    }

    /// Fins in which it was parted.
    pub fn splices(&self) -> &[SpliceEntry] {
        self.splices.as_deref().unwrap_or_default()
    }

    /// The slit at a place along the strip; a closed strip has none where it was opened.
    pub fn slit_at(&self, place: usize) -> Option<&SlitEntry> {
        let seam = self.is_closed() && (place == 0 || place + 1 == self.nodes.len());
        let node = self.nodes[place];
        self.slits().iter().find(|slit| slit.node == node && !seam)
    }

    /// The nodes before and after a place, across a splice too.
    pub fn beside(&self, place: usize) -> [Option<usize>; 2] {
        let node = self.nodes[place];
        let last = self.nodes.len() - 1;
        let across = |end: usize| {
            self.splices().iter().map(|splice| splice.fin).find_map(|fin| {
                // Travel runs to the right: a splice at the left ends on the first node.
                (fin[1 - end] == node).then_some(fin[end])
            })
        };
        let before = if place > 0 { Some(self.nodes[place - 1]) } else { across(0) };
        let after = if place < last { Some(self.nodes[place + 1]) } else { across(1) };
        [before, after]
    }

    /// The nodes at the other ends of the fins with which it ends at a node.
    pub fn ends_at(&self, node: usize) -> Vec<usize> {
        let last = self.nodes.len() - 1;
        let ends = [0, last].into_iter().filter(|&place| self.nodes[place] == node);
        let inner = ends.filter_map(|place| match self.beside(place) {
            [Some(inner), None] | [None, Some(inner)] => Some(inner),
            _ => None,
        });
        inner.collect()
    }

    /// Whether the lists fit each other and the structure's count of nodes.
    pub fn is_sound(&self, node_count: usize) -> bool {
        !self.nodes.is_empty()
            && self.axes.len() == self.nodes.len()
            && self.nodes.iter().all(|&node| node < node_count)
            && self.splices().iter().flat_map(|s| s.fin).all(|node| node < node_count)
    }
}

/// A node axis on a part, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AxisEntry {
    /// The node.
    #[serde(default)]
    pub node: usize,
    /// Its lower end.
    #[serde(with = "points")]
    #[cfg_attr(test, schemars(with = "[f64; 2]"))]
    pub bottom: Point2,
    /// Its upper end.
    #[serde(with = "points")]
    #[cfg_attr(test, schemars(with = "[f64; 2]"))]
    pub top: Point2,
}

/// A fold at a node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FoldEntry {
    /// The node.
    pub node: usize,
    /// Counter-clockwise along the travel, seen from above.
    pub angle_deg: f64,
}

/// The edge at which a slit is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum OpenEdge {
    /// The upper one.
    Top,
    /// The lower one.
    Bottom,
}

/// A slit for the part that crosses at a node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SlitEntry {
    /// The node.
    pub node: usize,
    /// Where it is open.
    pub from: OpenEdge,
    /// Between its walls, mm.
    pub width: f64,
    /// Along the axis, mm.
    pub depth: f64,
    /// Of its middle from the axis, mm, positive along the travel.
    pub offset: f64,
    /// Between the two parts.
    #[serde(default)]
    pub crossing_deg: f64,
    /// The part that comes in.
    pub partner: String,
}

/// A fin in which a strip was parted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SpliceEntry {
    /// Its nodes along the travel.
    pub fin: [usize; 2],
}
