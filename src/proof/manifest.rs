//! What the proof takes from `job.json` (contract §3): which parts there should be and where.

use crate::geometry::Point2;
use crate::proof::Limits;
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;

#[derive(Deserialize, Clone)]
pub(super) struct Manifest {
    pub format: String,
    pub version: u64,
    pub material: Material,
    #[serde(default)]
    pub sheet_stock: Vec<Stock>,
    pub parts: Vec<Part>,
    pub sheets: Vec<Sheet>,
    /// The parts that were made again, if it is not all of them.
    #[serde(default)]
    pub only: Option<Vec<String>>,
    #[serde(default)]
    pub proof: Written,
    /// The same parts in files for a service.
    #[serde(default)]
    pub order: Option<Order>,
}

/// Files for a service.
#[derive(Deserialize, Clone)]
pub(super) struct Order {
    pub kerf: f64,
    #[serde(default)]
    pub pdf: Option<String>,
    pub sheets: Vec<Sheet>,
}

impl Manifest {
    /// The manifest as if the files of the order were the job's own.
    pub(super) fn of_order(&self) -> Option<(Self, Order)> {
        let order = self.order.clone()?;
        let manifest = Self {
            material: Material { kerf: order.kerf, ..self.material },
            sheet_stock: Vec::new(),
            sheets: order.sheets.clone(),
            order: None,
            ..self.clone()
        };
        Some((manifest, order))
    }
}

/// What the files were when they were written.
#[derive(Deserialize, Default, Clone)]
pub(super) struct Written {
    /// How far they may be off.
    #[serde(default)]
    pub limits: Limits,
    /// SHA-256 by path.
    #[serde(default)]
    pub files: BTreeMap<String, String>,
}

#[derive(Deserialize, Clone, Copy)]
pub(super) struct Material {
    pub thickness: f64,
    pub kerf: f64,
    pub clearance: f64,
}

#[derive(Deserialize, Clone)]
pub(super) struct Stock {
    pub width: f64,
    pub height: f64,
    pub margin: f64,
    pub spacing: f64,
}

#[derive(Deserialize, Clone)]
pub(super) struct Part {
    pub id: String,
    #[serde(default)]
    pub kind: String,
    #[serde(default)]
    pub label: String,
    #[serde(deserialize_with = "ring")]
    pub outline: Vec<Point2>,
    #[serde(default, deserialize_with = "rings")]
    pub holes: Vec<Vec<Point2>>,
    /// A run of fins; single fins are runs of one.
    #[serde(alias = "fin")]
    pub strip: Option<Strip>,
    /// What it holds, if it is a connector.
    #[serde(default)]
    pub connector: Option<Connector>,
}

/// The plates of a node.
#[derive(Deserialize, Clone)]
pub(super) struct Connector {
    pub kind: Kind,
    pub node: usize,
    #[serde(default)]
    pub fins: Vec<(String, f64)>,
    #[serde(default)]
    pub slots: Vec<Slot>,
    #[serde(default)]
    pub thickness: f64,
    #[serde(default)]
    pub copies: Vec<Copy>,
}

/// One plate of a connector, placed across its axis.
#[derive(Deserialize, Clone)]
pub(super) struct Copy {
    pub height: f64,
    pub angle_deg: f64,
    pub fins: Vec<String>,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    Hub,
    Hinge,
}

/// Where a fin stands in its connector.
#[derive(Deserialize, Clone)]
pub(super) struct Slot {
    pub fin: String,
    /// The node at the other end of the fin there.
    #[serde(default)]
    pub to: Option<usize>,
    pub angle_deg: f64,
}

#[derive(Deserialize, Clone)]
pub(super) struct Strip {
    pub nodes: Vec<usize>,
    #[serde(default)]
    pub closed: bool,
    pub axes: Vec<Axis>,
    #[serde(default)]
    pub folds: Vec<Fold>,
    #[serde(default)]
    pub slits: Vec<Slit>,
    #[serde(default)]
    pub splices: Vec<Splice>,
    /// How far it stops from its first and last axis.
    #[serde(default)]
    pub setbacks: [f64; 2],
}

#[derive(Deserialize, Clone, Copy)]
pub(super) struct Axis {
    #[serde(deserialize_with = "point")]
    pub bottom: Point2,
    #[serde(deserialize_with = "point")]
    pub top: Point2,
}

#[derive(Deserialize, Clone)]
pub(super) struct Fold {
    pub node: usize,
    pub angle_deg: f64,
}

#[derive(Deserialize, Clone)]
pub(super) struct Slit {
    pub node: usize,
    pub from: Edge,
    pub width: f64,
    pub depth: f64,
    pub offset: f64,
    pub partner: String,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(super) enum Edge {
    Top,
    Bottom,
}

#[derive(Deserialize, Clone)]
pub(super) struct Splice {
    pub fin: [usize; 2],
}

#[derive(Deserialize, Clone)]
pub(super) struct Sheet {
    pub id: String,
    pub width: f64,
    pub height: f64,
    pub files: SheetFiles,
    pub placements: Vec<Placement>,
}

#[derive(Deserialize, Clone)]
pub(super) struct SheetFiles {
    #[serde(default)]
    pub dxf: Option<String>,
    #[serde(default)]
    pub svg: Option<String>,
}

#[derive(Deserialize, Clone)]
pub(super) struct Placement {
    pub part: String,
    #[serde(default = "one")]
    pub copy: usize,
    pub x: f64,
    pub y: f64,
    pub angle_deg: f64,
}

fn point<'de, D: Deserializer<'de>>(from: D) -> Result<Point2, D::Error> {
    <[f64; 2]>::deserialize(from).map(Point2::from)
}

fn ring<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Point2>, D::Error> {
    let ring = Vec::<[f64; 2]>::deserialize(from)?;
    Ok(ring.into_iter().map(Point2::from).collect())
}

fn rings<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Vec<Point2>>, D::Error> {
    let rings = Vec::<Vec<[f64; 2]>>::deserialize(from)?;
    Ok(rings.into_iter().map(|r| r.into_iter().map(Point2::from).collect()).collect())
}

const fn one() -> usize {
    1
}

impl Strip {
    /// The slit at a place along the strip; a closed strip has none where it was opened.
    pub(super) fn slit_at(&self, place: usize) -> Option<&Slit> {
        let seam = self.closed && (place == 0 || place + 1 == self.nodes.len());
        let node = self.nodes[place];
        self.slits.iter().find(|slit| slit.node == node && !seam)
    }

    /// The nodes before and after a place, across a splice too.
    pub(super) fn beside(&self, place: usize) -> [Option<usize>; 2] {
        let node = self.nodes[place];
        let last = self.nodes.len() - 1;
        let across = |end: usize| {
            self.splices.iter().map(|splice| splice.fin).find_map(|fin| {
                // Travel runs to the right: a splice at the left ends on the first node.
                (fin[1 - end] == node).then_some(fin[end])
            })
        };
        let before = if place > 0 { Some(self.nodes[place - 1]) } else { across(0) };
        let after = if place < last { Some(self.nodes[place + 1]) } else { across(1) };
        [before, after]
    }

    /// The nodes at the other ends of the fins with which it ends at a node.
    pub(super) fn ends_at(&self, node: usize) -> Vec<usize> {
        let last = self.nodes.len() - 1;
        let ends = [0, last].into_iter().filter(|&place| self.nodes[place] == node);
        let inner = ends.filter_map(|place| match self.beside(place) {
            [Some(inner), None] | [None, Some(inner)] => Some(inner),
            _ => None,
        });
        inner.collect()
    }

    /// Whether the lists fit each other and the structure's count of nodes.
    pub(super) fn is_sound(&self, node_count: usize) -> bool {
        !self.nodes.is_empty()
            && self.axes.len() == self.nodes.len()
            && self.nodes.iter().all(|&node| node < node_count)
            && self.splices.iter().flat_map(|s| s.fin).all(|node| node < node_count)
    }
}
