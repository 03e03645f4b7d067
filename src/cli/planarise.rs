//! `finwright planarise`: planar fins from any mesh.

use crate::cli::console::{Console, Terminal};
use crate::cli::flags::planarise::PlanariseArgs;
use crate::cli::input::{self, InputError};
use crate::cli::jobdir::JobDirError;
use crate::cli::outcome::{End, Failure, print};
use crate::design::planarise::{
    Iteration, Options, PictureError, PlanariseError, Planarised, picture, planarise,
    smoothed_axes,
};
use crate::diagnostic::Finding;
use crate::job::{AXES_FROM_NORMALS, Fix, Input, InputOptions};
use crate::structure::{Structure, interop, write_json, write_obj};
use crate::tolerance::Tolerance;
use crate::units::Unit;
use std::path::Path;

/// Runs the command.
pub(super) fn run(args: &PlanariseArgs, console: Console) -> Result<End, Failure> {
    let mut input = read(args)?;
    let options = options(args, &input);
    let given = input.draft.clone();
    let mut findings = std::mem::take(&mut input.findings);
    let mut terminal = Terminal::new(console, None);
    let result = planarise(input.draft, &options, &mut terminal);
    terminal.finish();
    let result = match result {
        Ok(result) => result,
        Err(PlanariseError::Stopped(stopped)) => return Err(stopped.into()),
        Err(PlanariseError::Refused(more)) => {
            findings.extend(more);
            console.findings(&findings);
            if args.json {
                print(&format!("{}\n", serde_json::json!({"findings": findings})));
            }
            return Ok(End::Refused);
        }
    };
    findings.retain(|finding| finding.code != AXES_FROM_NORMALS);
    findings.extend(result.findings.iter().cloned());
    let structure = match Structure::new(result.draft.clone(), &Tolerance::default()) {
        Ok((structure, _)) => Some(structure),
        Err(refused) => {
            findings.extend(refused.findings);
            None
        }
    };
    console.findings(&findings);
    let Some(structure) = structure else { return Ok(End::Refused) };
    write(args, &given, &result, &structure)?;
    if args.json {
        print(&format!("{}\n", report(&result, &findings)));
    }
    console.say(&summary(&result));
    Ok(End::of(&findings))
}

fn read(args: &PlanariseArgs) -> Result<Input, Failure> {
    let reading = InputOptions {
        units: args.units,
        axes: args.axes,
        fix: args.fix.clone(),
        weld_mm: args.weld,
        ..InputOptions::default()
    };
    let mut input = input::read(&args.mesh, &reading)?;
    let bad =
        |path: &Path, source| InputError::BadStructure { path: path.to_owned(), source };
    let draft = &mut input.draft;
    if let Some(path) = &args.upper {
        let upper = input::read(&path.to_string_lossy(), &reading)?.draft;
        *draft =
            interop::between(std::mem::take(draft), &upper).map_err(|e| bad(path, e))?;
    } else if let Some(path) = &args.axis_mesh {
        let other = input::read(&path.to_string_lossy(), &reading)?.draft;
        draft.axes = interop::axes_toward(draft, &other).map_err(|e| bad(path, e))?;
    } else if let Some(path) = &args.axis_lines {
        let text = input::text_of(path)?;
        let axes = interop::axes_from_lines(
            draft,
            &text,
            args.units.unwrap_or(Unit::Millimetre),
        );
        draft.axes = axes.map_err(|e| bad(path, e))?;
    }
    if let Some(depth) = args.depth {
        *draft = std::mem::take(draft).with_depth(depth.below, depth.above);
    }
    if args.smooth > 0 {
        draft.axes = smoothed_axes(draft, args.smooth);
    }
    Ok(input)
}

fn write(
    args: &PlanariseArgs,
    given: &crate::structure::Draft,
    result: &Planarised,
    structure: &Structure,
) -> Result<(), Failure> {
    let text = write_json(structure);
    match &args.output {
        Some(path) => to_disk(path, text.as_bytes())?,
        None if !args.json => {
            print(&text);
        }
        None => {}
    }
    if let Some(path) = &args.picture {
        let before = given.clone().with_fins(&result.draft.fin_ids());
        match picture(&before, &result.draft) {
            Ok(bytes) => to_disk(path, &bytes)?,
            Err(PictureError) => {
                return Err(InputError::UnknownFormat { path: path.clone() }.into());
            }
        }
    }
    if let Some(dir) = &args.export {
        let disk = |source| JobDirError::Disk { path: dir.clone(), source };
        std::fs::create_dir_all(dir).map_err(disk)?;
        for (ending, text) in interop_files(structure) {
            to_disk(&dir.join(format!("{}{ending}", structure.name())), text.as_bytes())?;
        }
    }
    Ok(())
}

fn interop_files(structure: &Structure) -> Vec<(&'static str, String)> {
    let [lower, upper] = interop::write_pair(structure);
    let [mesh, lines] = interop::write_lines(structure);
    vec![
        ("-lower.obj", lower),
        ("-upper.obj", upper),
        ("-vn.obj", write_obj(structure)),
        ("-mesh.obj", mesh),
        ("-axes.obj", lines),
        ("-compas.json", interop::write_compas(structure)),
        ("-fins.obj", interop::write_fins(structure)),
    ]
}

fn to_disk(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let disk = |source| JobDirError::Disk { path: path.to_owned(), source };
    Ok(std::fs::write(path, bytes).map_err(disk)?)
}

fn report(result: &Planarised, findings: &[Finding]) -> serde_json::Value {
    let step = |step: &Iteration| {
        serde_json::json!({
            "polish": step.polish,
            "planarity_weight": step.weight,
            "energy": step.energy,
            "worst_percent": step.worst * 100.0,
            "damping": step.damping,
            "taken": step.taken,
        })
    };
    serde_json::json!({
        "figures": result.figures,
        "history": result.history.iter().map(step).collect::<Vec<_>>(),
        "findings": findings,
    })
}

fn summary(result: &Planarised) -> String {
    let figures = &result.figures;
    if result.history.is_empty() {
        return format!(
            "{} fins are plane as they are: worst {:.6} %",
            figures.fins,
            figures.before.worst * 100.0
        );
    }
    format!(
        "{} fins: worst {:.3} % before, {:.6} % after {} steps; nodes moved up to {:.3} mm, \
         axes turned up to {:.1}°, {:.3} mm from the given surface",
        figures.fins,
        figures.before.worst * 100.0,
        figures.after.worst * 100.0,
        result.history.len(),
        figures.moves[1],
        figures.largest_turn.to_degrees(),
        figures.distance
    )
}

/// What was chosen.
fn options(args: &PlanariseArgs, input: &Input) -> Options {
    let held = |fix: &Option<Fix>| {
        fix.as_ref().map_or_else(Vec::new, |fix| fix.nodes(&input.draft))
    };
    Options {
        boundary_fins: args.boundary_fins,
        fixed_nodes: held(&args.hold),
        fixed_axes: held(&args.hold_axes),
        weights: args.weights.0.clone(),
        target: args.target / 100.0,
        tilt_limit: args.tilt_limit.to_radians(),
        move_limit: args.move_limit,
        steps: args.steps,
    }
}
