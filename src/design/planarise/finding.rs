//! Everything that can be wrong with planarising.

use crate::diagnostic::{Located, Place};
use crate::ids::{FaceId, FinId, NodeId};
use miette::Diagnostic;
use thiserror::Error;

/// A fact found while planarising.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "each variant's message says what its fields are")]
pub enum DesignFinding {
    #[error(
        "faces turned against their neighbours: {}, the first is face {}",
        faces.len(), faces[0]
    )]
    #[diagnostic(
        code(design::faces_turned),
        help("turn them round (\"unify normals\") so that all faces look to one side")
    )]
    FacesTurned { faces: Vec<FaceId> },

    #[error(
        "nodes where faces meet in a point and not along edges: {}, the first is node {}",
        nodes.len(), nodes[0]
    )]
    #[diagnostic(
        code(design::several_fans),
        help("split the node in two, or add the face that is missing between the fans")
    )]
    SeveralFans { nodes: Vec<NodeId> },

    #[error("no fin is left to planarise: every edge ({edges}) is on the boundary")]
    #[diagnostic(
        code(design::no_inner_fin),
        help("use `--boundary-fins`, or give a mesh of more than one face")
    )]
    NoInnerFin { edges: usize },

    #[error("the equations of {fins} fins need more memory than there is")]
    #[diagnostic(
        code(design::too_large),
        help("planarise the mesh in pieces, holding their common nodes with `--hold`")
    )]
    TooLarge { fins: usize },

    #[error(
        "fins that could not be made plane: {count}; the worst, fin {fin}, is out of plane \
         by {percent:.4} % of its diameter ({off_mm:.3} mm): {reason}"
    )]
    #[diagnostic(
        code(design::not_reached),
        help(
            "the target is {target_percent} % (`--target`); {}", reason.remedy()
        )
    )]
    NotReached {
        fin: FinId,
        count: usize,
        percent: f64,
        off_mm: f64,
        target_percent: f64,
        reason: Reason,
    },

    #[error(
        "edges on the boundary that carry no fin, so that the others can be plane: {count}"
    )]
    #[diagnostic(
        code(design::boundary_left),
        severity(Advice),
        help(
            "strips end at boundary nodes; `finwright planarise --boundary-fins` makes fins \
             of these edges too"
        )
    )]
    BoundaryLeft { count: usize },

    #[error("face {face} was turned over or folded by moving its nodes")]
    #[diagnostic(
        code(design::face_reversed),
        severity(Warning),
        help("make the mesh more even there, lower `--move-limit`, or hold its nodes")
    )]
    FaceReversed { face: FaceId },

    #[error("the axis of node {node} stands {tilt_deg:.1}° off the surface normal")]
    #[diagnostic(
        code(design::axis_near_tangent),
        severity(Warning),
        help(
            "fins get low and crossings acute there; start from steeper axes, or lower \
             `--tilt-limit` (now {limit_deg:.0}°)"
        )
    )]
    AxisNearTangent { node: NodeId, tilt_deg: f64, limit_deg: f64 },

    #[error(
        "fins ({fins}) were out of plane by up to {before_percent:.3} % of their diameter; \
         planarised it is {after_percent:.6} %: nodes moved by up to {move_mm:.2} mm, axes \
         turned by up to {turn_deg:.1}°"
    )]
    #[diagnostic(
        code(design::planarised),
        severity(Advice),
        help(
            "structure.json holds the new nodes and axes; `--planarise never` keeps the given \
             ones, `finwright planarise` lets you choose"
        )
    )]
    Planarised {
        fins: usize,
        before_percent: f64,
        after_percent: f64,
        move_mm: f64,
        turn_deg: f64,
    },
}

/// Why a fin could not be made plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Reason {
    /// A node or an axis of it is held.
    #[error("node {0} is held")]
    Held(NodeId),
    /// An axis is at its limit.
    #[error("the axis of node {0} is as close to the surface as it may be")]
    Tangent(NodeId),
    /// A face beside it was turned over.
    #[error("face {0} beside it is turned over")]
    Reversed(FaceId),
    /// A node is at its limit.
    #[error("node {0} has moved as far as it may")]
    Limit(NodeId),
    /// It lies on the boundary.
    #[error("it lies on the boundary, where edges have one neighbour only")]
    Boundary,
    /// None of these.
    #[error("the axes around it pull in different directions")]
    Crowded,
}

impl Reason {
    const fn remedy(self) -> &'static str {
        match self {
            Self::Held(_) => {
                "free the node, or the nodes around it (`--hold`, `--hold-axes`)"
            }
            Self::Tangent(_) => "raise `--tilt-limit`, or start from steeper axes",
            Self::Reversed(_) => "make the mesh more even there",
            Self::Limit(_) => {
                "raise `--move-limit`, or smooth the axes to start from (`--smooth`)"
            }
            Self::Boundary => "leave `--boundary-fins` out",
            Self::Crowded => {
                "smooth the axes to start from (`--smooth`), or raise `--steps`"
            }
        }
    }
}

impl Located for DesignFinding {
    fn place(&self) -> Place {
        match self {
            Self::FacesTurned { faces } => Place::faces(faces.clone()),
            Self::SeveralFans { nodes } => Place::nodes(nodes.clone()),
            Self::NotReached { fin, .. } => Place::fins([fin.ends()]),
            Self::FaceReversed { face } => Place::faces([*face]),
            Self::AxisNearTangent { node, .. } => Place::nodes([*node]),
            Self::NoInnerFin { .. }
            | Self::TooLarge { .. }
            | Self::BoundaryLeft { .. }
            | Self::Planarised { .. } => Place::default(),
        }
    }
}
