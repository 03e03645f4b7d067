//! `finwright design`: from a reference surface to a structure.

use crate::cli::at_scale;
use crate::cli::console::{Console, Terminal};
use crate::cli::flags::design::{AlignWhen, DesignArgs, SymmetryWhen};
use crate::cli::input;
use crate::cli::jobdir::JobDirError;
use crate::cli::outcome::{End, Failure, print};
use crate::design::planarise::PlanariseError;
use crate::design::surface::{FormatError, Polygons, Surface, clean, read_ply, read_stl};
use crate::design::{
    Align, ChainFinding, DesignFigures, Designed, SURFACES, SingularWish, Size, Wishes,
    design, design_picture, surface_named,
};
use crate::diagnostic::Finding;
use crate::geometry::Point3;
use crate::job::{AXES_FROM_NORMALS, InputOptions};
use crate::structure::{AxisRule, Structure, write_json};
use crate::tolerance::Tolerance;
use crate::units::Unit;
use miette::Diagnostic;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Nodes where neither their number nor the length of fins was given.
const NODES: usize = 700;

/// Fins of a singular node.
const FINS: [usize; 4] = [2, 3, 5, 6];

/// A line of a file of singular nodes that is none.
#[derive(Debug, Error, Diagnostic)]
#[error("{}: line {line} is no singular node", path.display())]
#[diagnostic(
    code(input::bad_singular),
    help("write X Y Z FINS, such as `120 40 15 3`; fins are 2, 3, 5 or 6")
)]
struct BadPlace {
    path: PathBuf,
    line: usize,
}

/// A line of a file of curves that is none.
#[derive(Debug, Error, Diagnostic)]
#[error("{}: line {line} is no polyline", path.display())]
#[diagnostic(
    code(input::bad_curve),
    help("write points as `v X Y Z` and curves as `l` with the numbers of two or more")
)]
struct BadCurve {
    path: PathBuf,
    line: usize,
}

/// A file that holds no surface.
#[derive(Debug, Error, Diagnostic)]
#[error("{}: {source}", path.display())]
#[diagnostic(forward(source))]
struct BadSurface {
    path: PathBuf,
    source: FormatError,
}

/// A surface with its name and what was found in it.
struct Read {
    name: String,
    polygons: Polygons,
    findings: Vec<Finding>,
}

/// Runs the command.
pub(super) fn run(args: &DesignArgs, console: Console) -> Result<End, Failure> {
    let Read { name, polygons, mut findings } = read(args)?;
    let mut terminal = Terminal::new(console, None);
    let ended = designed(args, &name, polygons, &mut findings, &mut terminal);
    terminal.finish();
    let Some((surface, designed, structure)) = ended? else {
        console.findings(&findings);
        if args.json {
            print(&format!("{}\n", serde_json::json!({"findings": findings})));
        }
        return Ok(End::Refused);
    };
    console.findings(&findings);
    write(args, &surface, &designed, &structure)?;
    if args.json {
        print(&format!("{}\n", report(&designed.figures, &findings)));
    }
    console.say(&summary(&name, &designed.figures));
    Ok(End::of(&findings))
}

/// The surface, the design on it, and the structure; `None` if it is refused, for what was
/// found.
fn designed(
    args: &DesignArgs,
    name: &str,
    polygons: Polygons,
    findings: &mut Vec<Finding>,
    terminal: &mut Terminal,
) -> Result<Option<(Surface, Designed, Structure)>, Failure> {
    let surface = match clean(polygons) {
        Ok((surface, more)) => {
            findings.extend(more);
            surface
        }
        Err(more) => {
            findings.extend(more);
            return Ok(None);
        }
    };
    let (surface, missed) = followed(args, surface)?;
    findings.extend(missed);
    let mut designed = match design(&surface, name, &wishes(args)?, terminal) {
        Ok(designed) => designed,
        Err(PlanariseError::Stopped(stopped)) => return Err(stopped.into()),
        Err(PlanariseError::Refused(more)) => {
            findings.extend(more);
            return Ok(None);
        }
    };
    let draft = &mut designed.draft;
    if let Some(fix) = &args.fix {
        draft.fixed = Some(fix.nodes(draft));
    }
    draft.design.get_or_insert_default().insert("seed".to_owned(), args.seed.into());
    findings.extend(designed.findings.iter().cloned());
    let structure = match Structure::new(draft.clone(), &Tolerance::default()) {
        Ok((structure, _)) => structure,
        Err(more) => {
            findings.extend(more.findings);
            return Ok(None);
        }
    };
    if let Some(wanted) = &args.for_scale {
        findings.push(at_scale::judged(&structure, wanted, terminal)?);
    }
    Ok(Some((surface, designed, structure)))
}

fn read(args: &DesignArgs) -> Result<Read, Failure> {
    let named = args.surface.as_deref().unwrap_or(SURFACES[0].name);
    if let Some(surface) = surface_named(named).filter(|_| !Path::new(named).is_file()) {
        let mut polygons = (surface.polygons)();
        polygons.axes = args.axes.axes(&polygons.positions, &polygons.faces);
        polygons.axes = polygons.axes.filter(|_| args.axes != AxisRule::Normal);
        return Ok(Read { name: named.to_owned(), polygons, findings: Vec::new() });
    }
    if let Some(read) = dense(Path::new(named), args)? {
        return Ok(read);
    }
    let reading =
        InputOptions { units: args.units, axes: args.axes, ..InputOptions::default() };
    let input = input::read(named, &reading)?;
    let mut findings = input.findings;
    let count = findings.len();
    findings.retain(|finding| finding.code != AXES_FROM_NORMALS);
    // Normals are smoothed; axes that were given are taken as they are.
    let normals = args.axes == AxisRule::Normal || findings.len() < count;
    let polygons = Polygons {
        positions: input.draft.positions,
        faces: input.draft.faces,
        axes: (!normals).then_some(input.draft.axes),
    };
    Ok(Read { name: input.draft.name, polygons, findings })
}

/// A surface in a format that holds no structures: STL or PLY.
fn dense(path: &Path, args: &DesignArgs) -> Result<Option<Read>, Failure> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let read = match ending.as_str() {
        "stl" => read_stl,
        "ply" => read_ply,
        _ => return Ok(None),
    };
    let bytes = input::raw_bytes_of(path)?;
    let bad = |source| Failure::of(BadSurface { path: path.to_owned(), source });
    let mut polygons = read(&bytes).map_err(bad)?;
    match args.axes {
        AxisRule::File => {}
        AxisRule::Normal => polygons.axes = None,
        rule => polygons.axes = rule.axes(&polygons.positions, &[]),
    }
    let unit = args.units.unwrap_or(Unit::Millimetre).millimetres();
    polygons.positions.iter_mut().for_each(|position| *position *= unit);
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Some(Read { name, polygons, findings: Vec::new() }))
}

fn wishes(args: &DesignArgs) -> Result<Wishes, Failure> {
    let singular = match args.singular.as_str() {
        "auto" => SingularWish::Auto,
        "none" => SingularWish::At(Vec::new()),
        path => SingularWish::At(places(Path::new(path), args)?),
    };
    Ok(Wishes {
        size: match args.cell {
            Some([first, second]) => Size::Cell((first * second).sqrt()),
            None => Size::Nodes(args.nodes.unwrap_or(NODES)),
        },
        aspect: args.cell.map_or(1.0, |[first, second]| first / second),
        align: match args.align {
            AlignWhen::Auto => Align::Auto,
            AlignWhen::None => Align::None,
            AlignWhen::Boundary => Align::Boundary,
        },
        depth: args.depth.map(|depth| [depth.below, depth.above]),
        boundary_fins: args.boundary_fins,
        singular,
        even: args.even,
        symmetry: args.symmetry == SymmetryWhen::Auto,
    })
}

/// The surface with the lines that fins are to follow.
fn followed(
    args: &DesignArgs,
    surface: Surface,
) -> Result<(Surface, Vec<Finding>), Failure> {
    match args.follow.as_deref() {
        None => Ok((surface, Vec::new())),
        Some("auto") => {
            // Shorter ones are noise.
            let least = surface.area().sqrt() / 10.0;
            Ok((surface.following_creases(least), Vec::new()))
        }
        Some(path) => {
            let (surface, missed) = surface.following(&curves(Path::new(path), args)?);
            let missed =
                missed.into_iter().map(|k| ChainFinding::CurveMissed { curve: k + 1 });
            Ok((surface, missed.map(Finding::from).collect()))
        }
    }
}

/// The polylines of an OBJ file.
fn curves(path: &Path, args: &DesignArgs) -> Result<Vec<Vec<Point3>>, Failure> {
    let unit = args.units.unwrap_or(Unit::Millimetre).millimetres();
    let (mut points, mut curves) = (Vec::new(), Vec::new());
    for (number, line) in input::text_of(path)?.lines().enumerate() {
        let bad = || Failure::of(BadCurve { path: path.to_owned(), line: number + 1 });
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f64> =
                    words.map_while(|word| word.parse().ok()).collect();
                let [x, y, z, ..] = numbers[..] else { return Err(bad()) };
                points.push(Point3::new(x, y, z) * unit);
            }
            Some("l") => {
                let corner = |word: &str| {
                    let number = word.split('/').next()?.parse::<i64>().ok()?;
                    let back = if number < 0 { points.len() as i64 + 1 } else { 0 };
                    points.get(usize::try_from(number + back - 1).ok()?).copied()
                };
                let curve: Option<Vec<Point3>> = words.map(corner).collect();
                curves.push(curve.filter(|curve| curve.len() > 1).ok_or_else(bad)?);
            }
            _ => {}
        }
    }
    Ok(curves)
}

/// Lines of three coordinates and a number of fins.
fn places(path: &Path, args: &DesignArgs) -> Result<Vec<(Point3, usize)>, Failure> {
    let unit = args.units.unwrap_or(Unit::Millimetre).millimetres();
    let text = input::text_of(path)?;
    let lines = text.lines().enumerate();
    let lines =
        lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let place = |(number, line): (usize, &str)| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let bad = || Failure::of(BadPlace { path: path.to_owned(), line: number + 1 });
        let &[x, y, z, fins] = words.as_slice() else { return Err(bad()) };
        let at = |word: &str| word.parse::<f64>().ok().filter(|x| x.is_finite());
        let (Some(x), Some(y), Some(z)) = (at(x), at(y), at(z)) else {
            return Err(bad());
        };
        let fins =
            fins.parse().ok().filter(|fins| FINS.contains(fins)).ok_or_else(bad)?;
        Ok((Point3::new(x, y, z) * unit, fins))
    };
    lines.map(place).collect()
}

fn write(
    args: &DesignArgs,
    surface: &Surface,
    designed: &Designed,
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
        to_disk(path, &design_picture(surface, designed).map_err(Failure::of)?)?;
    }
    Ok(())
}

fn to_disk(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let disk = |source| JobDirError::Disk { path: path.to_owned(), source };
    Ok(std::fs::write(path, bytes).map_err(disk)?)
}

fn report(figures: &DesignFigures, findings: &[Finding]) -> serde_json::Value {
    let mut report = serde_json::json!(figures);
    report["goals"] = serde_json::json!([]);
    report["light"] = serde_json::Value::Null;
    report["adaptation"] = serde_json::Value::Null;
    report["tried"] = serde_json::json!([]);
    report["findings"] = serde_json::json!(findings);
    report
}

fn summary(name: &str, figures: &DesignFigures) -> String {
    format!(
        "{name}: {} nodes, {} fins, {} singular nodes; {:.0} % of the fins inside between 0.7 \
         and 1.4 of {:.1} mm; worst fin {:.3} % before, {:.7} % after; axes turned up to \
         {:.1}°, nodes up to {:.3} mm off the surface",
        figures.nodes,
        figures.fins,
        figures.singular.len(),
        figures.edge.in_band * 100.0,
        figures.edge.wanted,
        figures.planarity_percent.before.max,
        figures.planarity_percent.after.max,
        figures.axis_turn_deg.max,
        figures.surface_distance.max
    )
}
