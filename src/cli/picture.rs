//! `check --node N --picture FILE.png`: a node as it is built.

use crate::cli::flags::structure::PictureArgs;
use crate::cli::jobdir::JobDirError;
use crate::cli::outcome::Failure;
use crate::fabrication::Fabrication;
use crate::report;
use miette::Diagnostic;
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

/// Draws what was asked for.
pub(super) fn draw(args: &PictureArgs, job: &Fabrication) -> Result<(), Failure> {
    let (Some(node), Some(path)) = (args.node, &args.picture) else { return Ok(()) };
    let thickness = job.settings.fit.thickness;
    let picture =
        report::node_picture(job, node.into(), thickness).map_err(Failure::of)?;
    let bytes = picture.ok_or_else(|| Failure::of(NoConnector { node }))?;
    let disk = |source| JobDirError::Disk { path: path.to_owned(), source };
    Ok(std::fs::write(path, bytes).map_err(disk)?)
}
