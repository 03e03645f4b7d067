//! Everything that can be wrong with a structure.

use crate::diagnostic::{Located, Place, short};
use crate::ids::{FaceId, FinId, NodeId, StripId};
use miette::Diagnostic;
use thiserror::Error;

/// A fact found in a draft or a structure.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "each variant's message says what its fields are")]
pub enum StructureFinding {
    #[error("there is no fin: {nodes} nodes and {faces} faces were read")]
    #[diagnostic(
        code(structure::empty),
        help("give a mesh with faces, or list `fins` between nodes")
    )]
    Empty { nodes: usize, faces: usize },

    #[error("the {what} of node {node} is {value}, which is no finite number")]
    #[diagnostic(
        code(structure::not_finite),
        help("repair the exporting program's output; every coordinate must be a number")
    )]
    NotFinite { node: NodeId, what: &'static str, value: f64 },

    #[error("the {what} of node {node} is {}, beyond {} mm", short(*value), short(*limit))]
    #[diagnostic(
        code(structure::too_large),
        help(
            "move the model near the origin (geographic coordinates lose their last \
             digits), and check its units and `--scale`"
        )
    )]
    TooLarge { node: NodeId, what: &'static str, value: f64, limit: f64 },

    #[error("{count} {what} are given for {nodes} nodes")]
    #[diagnostic(
        code(structure::count_mismatch),
        help("give one entry per node, in the order of `positions`")
    )]
    CountMismatch { what: &'static str, count: usize, nodes: usize },

    #[error("{count} families are given for {fins} fins")]
    #[diagnostic(
        code(structure::family_count),
        help(
            "give 1, 2 or null for each fin, in the order of `fins`, or leave them out"
        )
    )]
    FamilyCount { count: usize, fins: usize },

    #[error(
        "fin {fin} is given the family {family}, but there are families 1 and 2 alone"
    )]
    #[diagnostic(
        code(structure::bad_family),
        help("give 1, 2 or null for each fin, in the order of `fins`")
    )]
    BadFamily { fin: FinId, family: u8 },

    #[error("{what}{} names node {node}, but nodes are counted from 0 and there are {nodes}", ordinal(*index))]
    #[diagnostic(
        code(structure::index_out_of_range),
        help("only in OBJ files nodes are counted from 1")
    )]
    IndexOutOfRange {
        what: &'static str,
        index: Option<usize>,
        node: NodeId,
        nodes: usize,
    },

    #[error("the axis of node {node} has no length")]
    #[diagnostic(
        code(structure::zero_axis),
        help("give every node a direction, or use `--axes normal`")
    )]
    ZeroAxis { node: NodeId },

    #[error(
        "fins reach {} mm below and {} mm above node {node}: no depth to cut",
        short(*below), short(*above)
    )]
    #[diagnostic(
        code(structure::no_depth),
        help("give a positive depth, for instance `--depth 20,20`")
    )]
    NoDepth { node: NodeId, below: f64, above: f64 },

    #[error("face {face} {fault}")]
    #[diagnostic(
        code(structure::degenerate_face),
        help("remove the face, or merge its corners in the modelling program")
    )]
    DegenerateFace { face: FaceId, fault: FaceFault },

    #[error("faces {first} and {second} have the same corners")]
    #[diagnostic(code(structure::duplicate_face), help("remove one of the two"))]
    DuplicateFace { first: FaceId, second: FaceId },

    #[error("{count} faces meet in the edge between nodes {} and {}", fin.ends()[0], fin.ends()[1])]
    #[diagnostic(
        code(structure::non_manifold_edge),
        help("an edge may belong to two faces; remove or separate the others")
    )]
    NonManifoldEdge { fin: FinId, count: usize },

    #[error(
        "the faces cannot all look to one side, as on a Moebius strip: turned to agree \
         with their neighbours, faces {first} and {second} still do not"
    )]
    #[diagnostic(
        code(structure::not_orientable),
        help(
            "node axes need one side to point to; cut the mesh open along a row of edges"
        )
    )]
    NotOrientable { first: FaceId, second: FaceId },

    #[error("the faces around node {node} are {fans} fans that touch only there")]
    #[diagnostic(
        code(structure::non_manifold_node),
        severity(Warning),
        help("if that is not meant, split the node, or add the faces between")
    )]
    NonManifoldNode { node: NodeId, fans: usize },

    #[error("faces {first} and {second} run the same way along their common edge")]
    #[diagnostic(
        code(structure::face_orientation),
        severity(Warning),
        help("turn one of them round (\"unify normals\") so that all look to one side")
    )]
    FaceOrientation { first: FaceId, second: FaceId },

    #[error("face {face} looks against its node axes")]
    #[diagnostic(
        code(structure::face_against_axis),
        severity(Warning),
        help("turn the face round, or turn its axes, so that `above` is one side")
    )]
    FaceAgainstAxis { face: FaceId },

    #[error("the structure falls into {pieces} pieces; one begins at node {node}")]
    #[diagnostic(
        code(structure::disconnected),
        severity(Warning),
        help("nothing joins the pieces; if that is not meant, merge their nodes")
    )]
    Disconnected { pieces: usize, node: NodeId },

    #[error("nodes without a fin: {count}, the first is node {node}")]
    #[diagnostic(
        code(structure::loose_node),
        severity(Warning),
        help("they are kept so that numbers stay the same, and take no part")
    )]
    LooseNode { node: NodeId, count: usize },

    #[error("nodes {} are at one place and not joined", listed(nodes))]
    #[diagnostic(
        code(structure::coincident_nodes),
        help(
            "join them with `--weld 0.01` (OBJ files: what is nearer than so many mm becomes \
             one node), or merge the vertices in the modelling program"
        )
    )]
    CoincidentNodes { nodes: Vec<NodeId> },

    #[error("nodes {} and {} are {} mm apart and not joined", nodes[0], nodes[1], short(*off_mm))]
    #[diagnostic(
        code(structure::nodes_near),
        severity(Warning),
        help(
            "if they are meant to be one, join them with `--weld {}` (OBJ files), or merge \
             the vertices in the modelling program",
            short(2.0 * off_mm)
        )
    )]
    NodesNear { nodes: [NodeId; 2], off_mm: f64 },

    #[error("nodes {} and {} are {} mm apart", fin.ends()[0], fin.ends()[1], short(*length))]
    #[diagnostic(
        code(structure::short_fin),
        help("merge the two nodes; a fin needs a length")
    )]
    ShortFin { fin: FinId, length: f64 },

    #[error("fin {fin} is listed twice")]
    #[diagnostic(code(structure::duplicate_fin), help("list each fin once"))]
    DuplicateFin { fin: FinId },

    #[error("the axis of node {node} runs along fin {fin}: {angle_deg:.1}° between them")]
    #[diagnostic(
        code(structure::axis_along_fin),
        help("an axis must stand across its fins, by {least_deg:.0}° at least")
    )]
    AxisAlongFin { node: NodeId, fin: FinId, angle_deg: f64, least_deg: f64 },

    #[error("the axes of nodes {} and {} point to opposite sides", fin.ends()[0], fin.ends()[1])]
    #[diagnostic(
        code(structure::axes_opposed),
        help(
            "turn one of the two round, so that all axes point to the same side of the mesh"
        )
    )]
    AxesOpposed { fin: FinId },

    #[error(
        "fin {fin} is out of plane by {percent:.4} % of its diameter ({off_mm:.3} mm)"
    )]
    #[diagnostic(
        code(structure::fin_not_planar),
        help(
            "the limit is {limit_percent} % (`gate.planarity_limit_percent`); planarise the \
             axes, or use `--axes X,Y,Z` or `--axes point:X,Y,Z`"
        )
    )]
    FinNotPlanar { fin: FinId, percent: f64, off_mm: f64, limit_percent: f64 },

    #[error(
        "fin {fin} is slightly out of plane: {percent:.4} % of its diameter ({off_mm:.3} mm)"
    )]
    #[diagnostic(
        code(structure::fin_warped),
        severity(Warning),
        help("the sheet will take it up; planarise for an exact fit")
    )]
    FinWarped { fin: FinId, percent: f64, off_mm: f64 },

    #[error("the node axes of fin {fin} meet inside the fin")]
    #[diagnostic(
        code(structure::axes_cross_in_fin),
        help(
            "reduce the depth to at most {share_percent:.0} % of what it is (`--depth`), or \
             turn axes that point the wrong way"
        )
    )]
    AxesCrossInFin { fin: FinId, share_percent: f64 },

    #[error("fins {first} and {second} cut through each other away from their nodes")]
    #[diagnostic(
        code(structure::fins_cross),
        help("reduce the depth, or move the nodes apart")
    )]
    FinsCross { first: FinId, second: FinId },

    #[error(
        "more than {listed} pairs of fins cut through each other; no more are listed"
    )]
    #[diagnostic(
        code(structure::fins_cross_often),
        help("the depth is far too large for this mesh, or nodes are far out of place")
    )]
    FinsCrossOften { listed: usize },

    #[error("strip {strip} steps from node {} to node {}, where no fin is", step[0], step[1])]
    #[diagnostic(
        code(structure::strip_without_fin),
        help("list the nodes of a strip in the order of its fins")
    )]
    StripWithoutFin { strip: StripId, step: [NodeId; 2] },

    #[error("fin {fin} is on {count} strips")]
    #[diagnostic(
        code(structure::fin_not_on_one_strip),
        help("each fin belongs to one strip; leave `strips` out to have them traced")
    )]
    FinNotOnOneStrip { fin: FinId, count: usize },

    #[error(
        "strip {strip} would meet itself at node {meets}; it is split at node {node}"
    )]
    #[diagnostic(
        code(structure::strip_split),
        severity(Advice),
        help("a strip that crosses itself cannot be put together")
    )]
    StripSplit { strip: StripId, meets: NodeId, node: NodeId },
}

/// Nodes as people list them: `5 and 16`.
fn listed(nodes: &[NodeId]) -> String {
    let (last, first) = nodes
        .split_last()
        .map_or((String::new(), &[][..]), |(last, first)| (last.to_string(), first));
    let first: Vec<String> = first.iter().map(ToString::to_string).collect();
    format!("{} and {last}", first.join(", "))
}

/// The place of an entry in its list; nothing for a list as a whole.
fn ordinal(index: Option<usize>) -> String {
    index.map(|index| format!(" {index}")).unwrap_or_default()
}

/// What is wrong with a face.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum FaceFault {
    #[error("has {count} corners")]
    TooFewCorners { count: usize },
    #[error("comes to node {node} twice")]
    RepeatedNode { node: NodeId },
    #[error("has an area of {} mm²", short(*area_mm2))]
    NoArea { area_mm2: f64 },
}

impl Located for StructureFinding {
    fn place(&self) -> Place {
        match *self {
            Self::CoincidentNodes { ref nodes } => Place::nodes(nodes.iter().copied()),
            Self::NodesNear { nodes, .. } => Place::nodes(nodes),
            Self::Empty { .. }
            | Self::CountMismatch { .. }
            | Self::FamilyCount { .. }
            | Self::FinsCrossOften { .. } => Place::default(),
            Self::IndexOutOfRange { what: "face", index: Some(index), .. } => {
                Place::faces([FaceId::new(index)])
            }
            Self::IndexOutOfRange { what: "strip", index: Some(index), .. } => {
                Place::strip(StripId::new(index))
            }
            Self::IndexOutOfRange { .. } => Place::default(),
            Self::NotFinite { node, .. }
            | Self::TooLarge { node, .. }
            | Self::NonManifoldNode { node, .. }
            | Self::ZeroAxis { node }
            | Self::NoDepth { node, .. }
            | Self::Disconnected { node, .. }
            | Self::LooseNode { node, .. } => Place::nodes([node]),
            Self::DegenerateFace { face, .. } | Self::FaceAgainstAxis { face } => {
                Place::faces([face])
            }
            Self::DuplicateFace { first, second }
            | Self::NotOrientable { first, second }
            | Self::FaceOrientation { first, second } => Place::faces([first, second]),
            Self::AxisAlongFin { node, fin, .. } => Place::fins([fin.ends()]).at(node),
            Self::NonManifoldEdge { fin, .. }
            | Self::ShortFin { fin, .. }
            | Self::DuplicateFin { fin }
            | Self::BadFamily { fin, .. }
            | Self::FinNotPlanar { fin, .. }
            | Self::FinWarped { fin, .. }
            | Self::AxesCrossInFin { fin, .. }
            | Self::AxesOpposed { fin }
            | Self::FinNotOnOneStrip { fin, .. } => Place::fins([fin.ends()]),
            Self::FinsCross { first, second } => {
                Place::fins([first.ends(), second.ends()])
            }
            Self::StripWithoutFin { strip, step } => {
                Place::strip(strip).at(step[0]).at(step[1])
            }
            Self::StripSplit { strip, node, .. } => Place::strip(strip).at(node),
        }
    }
}
