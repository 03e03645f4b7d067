//! The plan of a job: how its fins are grouped into parts and what holds them, made once.

use crate::diagnostic::Finding;
use crate::ids::NodeId;
use crate::parts::connector::Connectors;
use crate::parts::lap::strips::Strips;
use crate::rigidity::Model;
use crate::structure::Structure;
use std::collections::BTreeMap;

/// What a structure is built as. The verdict judges it, parts and steps are made from it.
#[derive(Debug)]
pub struct Plan {
    /// The structure with its strips as they will be cut: closed ones opened at their
    /// smallest fold, those that would lie over themselves or run through discs split.
    pub structure: Structure,
    /// Its strips; `None` if every fin is a part of its own.
    pub(crate) strips: Option<Strips>,
    /// What holds ends of fins, by node.
    pub(crate) connectors: Connectors,
    /// Everything found on the way.
    pub(crate) findings: Vec<Finding>,
}

impl Plan {
    /// The plan as a mechanism: bodies and the axes and slots that they share.
    pub fn model(&self) -> Model {
        let connectors = self.connectors.iter();
        let moment_arms: BTreeMap<NodeId, f64> = connectors
            .filter_map(|(&node, connector)| Some((node, connector.moment_arm()?)))
            .collect();
        match &self.strips {
            Some(strips) => {
                Model::of_strips(&self.structure, &strips.unheld(), &moment_arms)
            }
            None => Model::of_fins(&self.structure, &moment_arms),
        }
    }

    /// What slits take of each fin at its nodes, by node and the one at the other end, mm.
    pub(crate) fn slits(&self) -> BTreeMap<[NodeId; 2], f64> {
        self.strips.as_ref().map(Strips::slits).unwrap_or_default()
    }
}
