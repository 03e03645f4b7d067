//! `check --node N --picture FILE.png`: a node as it is built.

use crate::cli::jobdir::JobDirError;
use crate::cli::run::Failure;
use crate::job::Job;
use crate::report;
use crate::template::Template;
use clap::Args;
use miette::Diagnostic;
use std::path::PathBuf;
use thiserror::Error;

/// There is nothing to draw.
#[derive(Debug, Error, Diagnostic)]
#[error("node {node} has no connector to draw")]
#[diagnostic(
    code(input::no_connector),
    help(
        "single fins have them (`--joint hub`, `--joint hinge`), where two or more meet, and \
         strips where they cannot lap"
    )
)]
struct NoConnector {
    node: usize,
}

/// What to draw.
#[derive(Debug, Args)]
pub struct PictureArgs {
    /// Draw this node's connector as it is built, into `--picture`
    #[arg(long, value_name = "N", requires = "picture")]
    node: Option<usize>,

    /// Where to draw it
    #[arg(long, value_name = "FILE.png", requires = "node")]
    picture: Option<PathBuf>,
}

/// Draws what was asked for.
pub(super) fn draw(
    args: &PictureArgs,
    job: &Job,
    template: &Template,
) -> Result<(), Failure> {
    let (Some(node), Some(path)) = (args.node, &args.picture) else { return Ok(()) };
    let thickness = template.material.thickness_mm;
    let picture = report::node_picture(job, node, thickness);
    let bytes = picture.ok_or_else(|| Failure::Other(Box::new(NoConnector { node })))?;
    std::fs::write(path, bytes).map_err(|source| {
        Failure::JobDir(JobDirError::Disk { path: path.to_owned(), source })
    })
}
