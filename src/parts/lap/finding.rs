//! What can be wrong with strips that lap.

use crate::diagnostic::{Located, Place, short};
use crate::ids::NodeId;
use miette::Diagnostic;
use thiserror::Error;

/// A fact found while strips are planned and made.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "each variant's message says what its fields are")]
pub enum LapFinding {
    #[error("{part} would lie over itself when flat; it is split at node {node}")]
    #[diagnostic(
        code(parts::strip_overlaps_itself),
        severity(Advice),
        help("two strips take its place")
    )]
    OverlapsItself { part: String, node: NodeId },

    #[error(
        "nothing holds the end of {part} at node {node}: it cannot lap with the {others} \
         other fins there and is set back by {setback_mm:.2} mm{}",
        because(why.as_deref())
    )]
    #[diagnostic(
        code(parts::strip_end_unheld),
        severity(Warning),
        help(
            "glue it, or give the discs room: deeper fins, a larger scale, a thinner sheet"
        )
    )]
    StripEndUnheld {
        part: String,
        node: NodeId,
        others: usize,
        setback_mm: f64,
        why: Option<String>,
    },

    #[error("{first} and {second} both run through node {node} but do not cross there")]
    #[diagnostic(
        code(parts::strips_touch),
        help(
            "two strips can share an axis only by crossing, and discs (`--hubs {node}`) have no \
             room; let one of them end there"
        )
    )]
    StripsTouch { first: String, second: String, node: NodeId },

    #[error("{count} strips run through node {node}")]
    #[diagnostic(
        code(parts::too_many_strips),
        help(
            "two strips can be half-lapped on one axis, and discs (`--hubs {node}`) have no \
             room; let the others end there"
        )
    )]
    TooManyStrips { node: NodeId, count: usize },

    #[error(
        "{first} and {second} cross at {angle_deg:.1}° at node {node}; the slit would be \
         {width_mm:.1} mm wide"
    )]
    #[diagnostic(
        code(parts::crossing_too_sharp),
        help(
            "at least {}° (`gate.crossing_least_deg`) are needed for the joint to hold; turn \
             the mesh's edges apart",
            short(*least_deg)
        )
    )]
    CrossingTooSharp {
        first: String,
        second: String,
        node: NodeId,
        angle_deg: f64,
        width_mm: f64,
        least_deg: f64,
    },

    #[error(
        "{first} and {second} cross at {angle_deg:.1}° at node {node}; the joint lets them \
         turn by {play_deg:.0}°"
    )]
    #[diagnostic(
        code(parts::crossing_oblique),
        severity(Warning),
        help("its angle must come from the rest of the structure; use a gauge or glue")
    )]
    CrossingOblique {
        first: String,
        second: String,
        node: NodeId,
        angle_deg: f64,
        play_deg: f64,
    },

    #[error("{part} keeps {web_mm:.2} mm behind its slit at node {node}")]
    #[diagnostic(
        code(parts::web_too_thin),
        help(
            "at least {least_mm} mm are needed (`material.web_least_mm`); give the fins more \
             depth, or move `joint.lap_split` toward the other strip"
        )
    )]
    WebTooThin { part: String, node: NodeId, web_mm: f64, least_mm: f64 },

    #[error("{part} keeps only {web_mm:.2} mm behind its slit at node {node}")]
    #[diagnostic(
        code(parts::web_thin),
        severity(Warning),
        help(
            "{wanted_mm} mm are recommended (`material.web_mm`); give the fins more depth"
        )
    )]
    WebThin { part: String, node: NodeId, web_mm: f64, wanted_mm: f64 },

    #[error(
        "{part} keeps {web_mm:.2} mm between its slits at nodes {} and {}",
        fin[0], fin[1]
    )]
    #[diagnostic(
        code(parts::slits_too_near),
        help(
            "at least {least_mm} mm are needed (`material.web_least_mm`); enlarge the \
             structure, or use a thinner sheet"
        )
    )]
    SlitsTooNear { part: String, fin: [NodeId; 2], web_mm: f64, least_mm: f64 },

    #[error(
        "{part} keeps only {web_mm:.2} mm between its slits at nodes {} and {}",
        fin[0], fin[1]
    )]
    #[diagnostic(
        code(parts::slits_near),
        severity(Warning),
        help(
            "{wanted_mm} mm are recommended (`material.web_mm`); enlarge the structure, or \
             use a thinner sheet"
        )
    )]
    SlitsNear { part: String, fin: [NodeId; 2], web_mm: f64, wanted_mm: f64 },

    #[error(
        "{part} folds by {fold_deg:.1}° at node {node}: a bend of radius {radius_mm:.0} mm, \
         {ratio:.0} times the thickness, would break it"
    )]
    #[diagnostic(
        code(parts::bend_breaks),
        help(
            "the sheet takes {limit} times its thickness (`bend.crack`): {}",
            relief(*grow, *thinner_mm)
        )
    )]
    BendBreaks {
        part: String,
        node: NodeId,
        fold_deg: f64,
        radius_mm: f64,
        ratio: f64,
        limit: f64,
        grow: f64,
        thinner_mm: f64,
    },

    #[error(
        "{part} folds by {fold_deg:.1}° at node {node}: a bend of radius {radius_mm:.0} mm, \
         {ratio:.0} times the thickness"
    )]
    #[diagnostic(
        code(parts::bend_tight),
        severity(Warning),
        help(
            "a model stands {limit} times its thickness for weeks (`bend.model`); enlarge it \
             {grow:.1} times, or bend the strip with heat"
        )
    )]
    BendTight {
        part: String,
        node: NodeId,
        fold_deg: f64,
        radius_mm: f64,
        ratio: f64,
        limit: f64,
        grow: f64,
    },

    #[error(
        "{part} has to give way while it is put in after node {node}: its axes lean from each \
         other, and it bends to a radius of {radius_mm:.0} mm, {ratio:.0} times the thickness"
    )]
    #[diagnostic(
        code(parts::insertion_tight),
        severity(Warning),
        help(
            "{limit} times is what a model stands (`bend.model`): zip it in slowly from one \
             end, raise `material.clearance_mm`, make the fins less deep, or enlarge it"
        )
    )]
    InsertionTight { part: String, node: NodeId, radius_mm: f64, ratio: f64, limit: f64 },

    #[error(
        "{part} is {length_mm:.0} mm long, fits no sheet, and no fin of it can take a splice"
    )]
    #[diagnostic(
        code(parts::no_place_for_splice),
        help(
            "a splice needs {needed_mm:.0} mm of fin between two slits and as much height; use \
             a larger sheet, or a smaller scale"
        )
    )]
    NoPlaceForSplice { part: String, length_mm: f64, needed_mm: f64 },
}

/// Why discs do not hold an end.
fn because(why: Option<&str>) -> String {
    why.map(|why| format!("; discs have no room: {why}")).unwrap_or_default()
}

/// What would save a strip from breaking.
fn relief(grow: f64, thinner_mm: f64) -> String {
    if thinner_mm < 0.05 {
        return "its slits leave hardly any length to bend; enlarge the structure"
            .to_owned();
    }
    format!(
        "enlarge the structure {grow:.1} times, use a sheet of {thinner_mm:.1} mm, or one that \
         folds"
    )
}

impl Located for LapFinding {
    fn place(&self) -> Place {
        match self {
            Self::OverlapsItself { part, node }
            | Self::StripEndUnheld { part, node, .. }
            | Self::WebTooThin { part, node, .. }
            | Self::WebThin { part, node, .. }
            | Self::BendBreaks { part, node, .. }
            | Self::BendTight { part, node, .. }
            | Self::InsertionTight { part, node, .. } => {
                Place::part(part.clone()).at(*node)
            }
            Self::StripsTouch { first, second, node }
            | Self::CrossingTooSharp { first, second, node, .. }
            | Self::CrossingOblique { first, second, node, .. } => Place {
                parts: vec![first.clone(), second.clone()],
                ..Place::nodes([*node])
            },
            Self::TooManyStrips { node, .. } => Place::nodes([*node]),
            Self::SlitsTooNear { part, fin, .. } | Self::SlitsNear { part, fin, .. } => {
                Place { parts: vec![part.clone()], ..Place::fins([*fin]) }
            }
            Self::NoPlaceForSplice { part, .. } => Place::part(part.clone()),
        }
    }
}
