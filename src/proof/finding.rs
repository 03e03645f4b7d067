//! What can be wrong with written files.

use crate::diagnostic::{Located, Place};
use crate::geometry::Point2;
use miette::Diagnostic;
use std::fmt;
use thiserror::Error;

/// Where in a job: file, parts, node, and the place on the sheet.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spot {
    /// Path inside the job directory.
    pub file: String,
    /// Names of parts.
    pub parts: Vec<String>,
    /// Node of the structure.
    pub node: Option<usize>,
    /// On the sheet, mm.
    pub at: Option<Point2>,
}

impl Spot {
    /// Somewhere in a file.
    pub fn file(file: &str) -> Self {
        Self { file: file.to_owned(), ..Self::default() }
    }

    /// The same, narrowed to a part.
    #[must_use]
    pub fn part(mut self, part: &str) -> Self {
        self.parts.push(part.to_owned());
        self
    }

    /// The same, narrowed to a node.
    #[must_use]
    pub fn node(self, node: usize) -> Self {
        Self { node: Some(node), ..self }
    }

    /// The same, narrowed to a place on the sheet.
    #[must_use]
    pub fn at(self, at: Point2) -> Self {
        Self { at: Some(at), ..self }
    }
}

impl fmt::Display for Spot {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if !self.parts.is_empty() {
            write!(f, ": {}", self.parts.join(", "))?;
        }
        if let Some(node) = self.node {
            write!(f, " at node {node}")?;
        }
        match self.at {
            Some(at) => write!(f, " (x {:.1}, y {:.1} mm)", at.x, at.y),
            None => Ok(()),
        }
    }
}

/// A fact found while reading a job back.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "each variant's message says what its fields are")]
pub enum ProofFinding {
    #[error("{spot}: the file is missing")]
    #[diagnostic(code(proof::file_missing), help("make the job again"))]
    FileMissing { spot: Spot },

    #[error("{spot}: {reason}")]
    #[diagnostic(
        code(proof::unreadable_file),
        help("make the job again, or save the file again as ASCII DXF, SVG or PDF")
    )]
    Unreadable { spot: Spot, reason: String },

    #[error("{spot}: the file was changed after it was written")]
    #[diagnostic(
        code(proof::file_changed),
        severity(Advice),
        help("what its lines are now was measured; other findings say what differs")
    )]
    FileChanged { spot: Spot },

    #[error("{spot}: the file does not say that it is in millimetres")]
    #[diagnostic(
        code(proof::unit_missing),
        severity(Warning),
        help("choose millimetres where it is opened, or save it with its unit")
    )]
    UnitMissing { spot: Spot },

    #[error("{spot}: everything is drawn {factor:.4} times as large as it should be")]
    #[diagnostic(
        code(proof::scaled),
        help("25.4 is inches taken for millimetres: set the unit where it was exported")
    )]
    Scaled { spot: Spot, factor: f64 },

    #[error(
        "{spot}: {missing} of {listed} parts are not in the file; it is of another job"
    )]
    #[diagnostic(
        code(proof::other_job),
        help("put back the file that was written with this job.json")
    )]
    OtherJob { spot: Spot, missing: usize, listed: usize },

    #[error("{spot}: the part is missing")]
    #[diagnostic(code(proof::part_missing), help("put it back, or make the job again"))]
    PartMissing { spot: Spot },

    #[error("{spot}: the part lies {by_mm:.2} mm from where it is listed")]
    #[diagnostic(
        code(proof::part_moved),
        severity(Advice),
        help("it is cut as well; only job.json and the pictures show it elsewhere")
    )]
    PartMoved { spot: Spot, by_mm: f64 },

    #[error("{spot}: the part lies where {other} is listed")]
    #[diagnostic(
        code(proof::parts_swapped),
        help("swap their outlines and lettering together, or make the job again")
    )]
    PartsSwapped { spot: Spot, other: String },

    #[error("{spot}: the part is mirrored; its labelled face would be the wrong one")]
    #[diagnostic(
        code(proof::part_mirrored),
        help("mirror it back; parts may be turned only")
    )]
    PartMirrored { spot: Spot },

    #[error("{spot}: a kerf of {kerf_mm:.3} mm is in the line, not {listed_mm} mm")]
    #[diagnostic(
        code(proof::kerf_wrong),
        help(
            "outer lines grow by half a kerf, holes shrink; a negative kerf is the wrong way \
             round, 0 is a line without kerf"
        )
    )]
    KerfWrong { spot: Spot, kerf_mm: f64, listed_mm: f64 },

    #[error("{spot}: the part is lettered {reads}")]
    #[diagnostic(
        code(proof::wrong_label),
        help("it would be mistaken when put together")
    )]
    WrongLabel { spot: Spot, reads: String },

    #[error("{spot}: {length_mm:.1} mm are drawn twice")]
    #[diagnostic(
        code(proof::doubled_line),
        help("delete the second line: cut twice, the kerf grows and edges burn")
    )]
    DoubledLine { spot: Spot, length_mm: f64 },

    #[error("{spot}: a cut line of {length_mm:.1} mm is open")]
    #[diagnostic(code(proof::open_line), help("join its ends, or delete it"))]
    OpenLine { spot: Spot, length_mm: f64 },

    #[error("{spot}: a closed cut line belongs to no part")]
    #[diagnostic(code(proof::unknown_contour), help("delete it, or list its part"))]
    UnknownContour { spot: Spot },

    #[error("{spot}: {count} {kind} on layer {layer:?} cannot be proved")]
    #[diagnostic(
        code(proof::unread_entity),
        severity(Warning),
        help("explode blocks and turn curves into polylines before saving")
    )]
    UnreadEntity { spot: Spot, kind: String, layer: String, count: usize },

    #[error("{spot}: {lines} lines are on no layer of the job")]
    #[diagnostic(
        code(proof::unknown_layer),
        severity(Warning),
        help("cut lines belong on CUT_OUTER and CUT_INNER; others are not read")
    )]
    UnknownLayer { spot: Spot, lines: usize },

    #[error("{spot}: the outline is {by_mm:.3} mm off the part's shape")]
    #[diagnostic(
        code(proof::outline_differs),
        help("put the corner back, or make the job again")
    )]
    OutlineDiffers { spot: Spot, by_mm: f64 },

    #[error("{spot}: {found} holes are drawn, {listed} are listed")]
    #[diagnostic(code(proof::holes_differ), help("put them back, or make the job again"))]
    HolesDiffer { spot: Spot, found: usize, listed: usize },

    #[error("{spot}: there is no slit for {partner}")]
    #[diagnostic(code(proof::slit_missing), help("make the job again"))]
    SlitMissing { spot: Spot, partner: String },

    #[error("{spot}: the slit is {by_mm:.3} mm off its axis's place")]
    #[diagnostic(
        code(proof::slit_moved),
        help("both walls must lie beside the node axis as listed")
    )]
    SlitMoved { spot: Spot, by_mm: f64 },

    #[error(
        "{spot}: the slit is {width_mm:.3} mm wide, {play_mm:.3} mm more than what comes in; \
         {clearance_mm} mm are wanted"
    )]
    #[diagnostic(code(proof::slit_narrow), help("the parts would jam; widen it"))]
    SlitNarrow { spot: Spot, width_mm: f64, play_mm: f64, clearance_mm: f64 },

    #[error(
        "{spot}: the slit is {width_mm:.3} mm wide, {play_mm:.3} mm more than what comes in; \
         {clearance_mm} mm are wanted"
    )]
    #[diagnostic(
        code(proof::slit_wide),
        severity(Warning),
        help("the joint will rattle; narrow the slit, or glue it")
    )]
    SlitWide { spot: Spot, width_mm: f64, play_mm: f64, clearance_mm: f64 },

    #[error("{spot}: the slits of the pair are {short_mm:.3} mm too short to meet")]
    #[diagnostic(
        code(proof::slit_short),
        help("deepen one of them: the strips would stand out by that much")
    )]
    SlitShort { spot: Spot, short_mm: f64 },

    #[error("{spot}: the slit is {depth_mm:.3} mm deep, not {listed_mm:.3} mm")]
    #[diagnostic(
        code(proof::slit_depth),
        severity(Warning),
        help("the pair still meets; look at the web behind it")
    )]
    SlitDepth { spot: Spot, depth_mm: f64, listed_mm: f64 },

    #[error(
        "{spot}: the end reaches to {distance_mm:.3} mm of the axis; {needed_mm:.3} mm are needed"
    )]
    #[diagnostic(
        code(proof::end_in_the_way),
        help("the plates of the node would run into each other: set the end back")
    )]
    EndInTheWay { spot: Spot, distance_mm: f64, needed_mm: f64 },

    #[error(
        "{spot}: the fold is listed as {listed_deg:.3}°, the structure needs {needed_deg:.3}°"
    )]
    #[diagnostic(
        code(proof::fold_wrong),
        help("folds turn toward the labelled face if positive; make the job again")
    )]
    FoldWrong { spot: Spot, listed_deg: f64, needed_deg: f64 },

    #[error(
        "{spot}: {fin} stands at {found_deg:.3}°, the structure needs {needed_deg:.3}°"
    )]
    #[diagnostic(
        code(proof::slot_turned),
        help(
            "angles count counter-clockwise from the connector's first fin, seen from above; a \
             wrong fin or a turned disc shows so too; make the job again"
        )
    )]
    SlotTurned { spot: Spot, fin: String, found_deg: f64, needed_deg: f64 },

    #[error("{spot}: the fin to node {to} is {by_mm:.3} mm off the one in the structure")]
    #[diagnostic(code(proof::fin_differs), help("make the job again"))]
    FinDiffers { spot: Spot, to: usize, by_mm: f64 },

    #[error(
        "{spot}: folded and joined, the axes of these parts are {gap_mm:.3} mm apart"
    )]
    #[diagnostic(
        code(proof::node_gap),
        help("the parts do not fold into the structure; make the job again")
    )]
    NodeGap { spot: Spot, gap_mm: f64 },

    #[error("{spot}: they would run {depth_mm:.2} mm into each other when assembled")]
    #[diagnostic(
        code(proof::parts_collide),
        help(
            "compare the heights in job.json and the cuts of both parts with a job as it was made"
        )
    )]
    PartsCollide { spot: Spot, depth_mm: f64 },

    #[error("{spot}: the parts overlap")]
    #[diagnostic(code(proof::parts_overlap), help("move them apart, or nest again"))]
    PartsOverlap { spot: Spot },

    #[error("{spot}: the parts are {distance_mm:.3} mm apart; {least_mm} mm are needed")]
    #[diagnostic(
        code(proof::parts_too_near),
        help("move them apart, or lower `spacing_mm` of the sheet")
    )]
    PartsTooNear { spot: Spot, distance_mm: f64, least_mm: f64 },

    #[error("{spot}: the part reaches {by_mm:.3} mm into the margin")]
    #[diagnostic(
        code(proof::part_in_margin),
        help("move it inside, or lower `margin_mm` of the sheet")
    )]
    PartInMargin { spot: Spot, by_mm: f64 },

    #[error("{spot}: {what} differs from the DXF by {by:.3}")]
    #[diagnostic(
        code(proof::formats_differ),
        help(
            "one of the files was edited; cut from one format only, or make the job again"
        )
    )]
    FormatsDiffer { spot: Spot, what: String, by: f64 },

    #[error("{spot}: its nodes, axes, folds and slits do not fit the structure")]
    #[diagnostic(code(proof::bad_list), help("make the job again"))]
    BadList { spot: Spot },
}

impl ProofFinding {
    /// Where it was found.
    pub fn spot(&self) -> &Spot {
        match self {
            Self::FileMissing { spot }
            | Self::Unreadable { spot, .. }
            | Self::FileChanged { spot }
            | Self::UnitMissing { spot }
            | Self::Scaled { spot, .. }
            | Self::OtherJob { spot, .. }
            | Self::PartMissing { spot }
            | Self::PartMoved { spot, .. }
            | Self::PartsSwapped { spot, .. }
            | Self::PartMirrored { spot }
            | Self::KerfWrong { spot, .. }
            | Self::WrongLabel { spot, .. }
            | Self::DoubledLine { spot, .. }
            | Self::OpenLine { spot, .. }
            | Self::UnknownContour { spot }
            | Self::UnreadEntity { spot, .. }
            | Self::UnknownLayer { spot, .. }
            | Self::OutlineDiffers { spot, .. }
            | Self::HolesDiffer { spot, .. }
            | Self::SlitMissing { spot, .. }
            | Self::SlitMoved { spot, .. }
            | Self::SlitNarrow { spot, .. }
            | Self::SlitWide { spot, .. }
            | Self::SlitShort { spot, .. }
            | Self::SlitDepth { spot, .. }
            | Self::EndInTheWay { spot, .. }
            | Self::FoldWrong { spot, .. }
            | Self::FinDiffers { spot, .. }
            | Self::SlotTurned { spot, .. }
            | Self::NodeGap { spot, .. }
            | Self::PartsCollide { spot, .. }
            | Self::PartsOverlap { spot }
            | Self::PartsTooNear { spot, .. }
            | Self::PartInMargin { spot, .. }
            | Self::FormatsDiffer { spot, .. }
            | Self::BadList { spot } => spot,
        }
    }
}

impl Located for ProofFinding {
    fn place(&self) -> Place {
        let spot = self.spot();
        Place {
            file: Some(spot.file.clone()),
            parts: spot.parts.clone(),
            nodes: spot.node.into_iter().collect(),
            at: spot.at.map(|p| [p.x, p.y].map(|mm| (mm * 1e3).round() / 1e3)),
            ..Place::default()
        }
    }
}
