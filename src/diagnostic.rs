//! Findings: what is wrong, where, how far, and what to do about it.
//!
//! Each stage has an enum of what it can find; a variant is a fact with its numbers.
//! `thiserror` writes the message, `miette` carries code, severity and help, and
//! [`Located`] the place. [`Finding`] is their common, serialisable form.

use crate::ids::{FaceId, NodeId, StripId};
use miette::Diagnostic;
use serde::{Deserialize, Serialize};

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Good to know.
    Note,
    /// The job can be cut, but look at it first.
    Warning,
    /// Nothing is cut while this stands.
    Error,
}

/// Where something was found, in the bare numbers of files; empty fields do not apply.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Place {
    /// Nodes, counted from 0 as in the structure.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub nodes: Vec<usize>,
    /// Fins, by their two nodes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fins: Vec<[usize; 2]>,
    /// Faces of the base mesh, counted from 0.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<usize>,
    /// Strips of the structure, counted from 0.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub strips: Vec<usize>,
    /// Parts, by their ids.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<String>,
    /// Line of the input file, counted from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// File of a job directory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// On the sheet, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
}

impl Place {
    /// At these nodes.
    pub fn nodes(nodes: impl IntoIterator<Item: Into<NodeId>>) -> Self {
        let nodes = nodes.into_iter().map(|node| node.into().index()).collect();
        Self { nodes, ..Self::default() }
    }

    /// In these fins.
    pub fn fins<N: Into<NodeId>>(fins: impl IntoIterator<Item = [N; 2]>) -> Self {
        let bare = |node: N| node.into().index();
        let fins = fins.into_iter().map(|fin| fin.map(bare)).collect();
        Self { fins, ..Self::default() }
    }

    /// In these faces.
    pub fn faces(faces: impl IntoIterator<Item = FaceId>) -> Self {
        let faces = faces.into_iter().map(FaceId::index).collect();
        Self { faces, ..Self::default() }
    }

    /// In this strip.
    pub fn strip(strip: StripId) -> Self {
        Self { strips: vec![strip.index()], ..Self::default() }
    }

    /// In this part.
    pub fn part(part: impl Into<String>) -> Self {
        Self { parts: vec![part.into()], ..Self::default() }
    }

    /// In this line of the input file.
    pub fn line(line: usize) -> Self {
        // 0 stands for a line that could not be found.
        Self { line: (line > 0).then_some(line), ..Self::default() }
    }

    /// The same place, narrowed to a node.
    #[must_use]
    pub fn at(mut self, node: impl Into<NodeId>) -> Self {
        self.nodes.push(node.into().index());
        self
    }
}

/// A fact that knows its place.
pub trait Located {
    /// Where it was found.
    fn place(&self) -> Place;
}

/// One thing found, ready to be shown or written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// `stage::what_is_wrong`; never changes.
    pub code: String,
    /// What was found, with the numbers.
    pub message: String,
    /// What to do and which setting to touch.
    pub help: String,
    /// Where.
    pub place: Place,
}

impl<F: Diagnostic + Located> From<F> for Finding {
    fn from(fact: F) -> Self {
        let place = fact.place();
        Self::new(&fact, place)
    }
}

impl Finding {
    /// A fact at a place.
    pub fn new(fact: &dyn Diagnostic, place: Place) -> Self {
        let text = |part: Option<Box<dyn std::fmt::Display + '_>>| {
            part.map(|part| part.to_string()).unwrap_or_default()
        };
        Self {
            severity: match fact.severity() {
                Some(miette::Severity::Advice) => Severity::Note,
                Some(miette::Severity::Warning) => Severity::Warning,
                Some(miette::Severity::Error) | None => Severity::Error,
            },
            code: text(fact.code()),
            message: fact.to_string(),
            help: text(fact.help()),
            place,
        }
    }
}

/// A number for a message: six digits at most, so that nobody has to count zeros.
pub fn short(value: f64) -> String {
    let six: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if six == 0.0 || !six.is_finite() || (0.0001..1e9).contains(&six.abs()) {
        format!("{}", six + 0.0)
    } else {
        format!("{six:e}")
    }
}

/// Whether nothing found forbids cutting.
pub fn passes(findings: &[Finding]) -> bool {
    findings.iter().all(|finding| finding.severity != Severity::Error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_messages_are_short() {
        let cases = [
            (20.0, "20"),
            (-0.0, "0"),
            (0.1 + 0.2, "0.3"),
            (1234.5678, "1234.57"),
            (1e20, "1e20"),
            (-1.0 / 3e7, "-3.33333e-8"),
            (f64::NAN, "NaN"),
        ];
        for (value, expected) in cases {
            assert_eq!(short(value), expected);
        }
    }
}
