//! `finwright nest`: parts of any origin onto sheets, or into a strip.

use crate::cli::console::{Console, Terminal};
use crate::cli::flags::nest::NestArgs;
use crate::cli::flags::value::EffortLevel;
use crate::cli::input::{self, InputError};
use crate::cli::jobdir::{self, Kept};
use crate::cli::nest_drawing;
use crate::cli::nest_input::{self, Order, Task};
use crate::cli::nest_progress::Progress;
use crate::cli::outcome::{End, Failure, print};
use crate::diagnostic::{Finding, Located, Severity};
use crate::export::{self, PngLook};
use crate::gate::approve_loose;
use crate::json;
use crate::nest::{self, Effort, NestError, Shape, Solution, Stock};
use crate::report::{Nested, free_maps, layout_json, layout_sheets};
use crate::settings::Settings;
use crate::watch::Watch;
use std::path::{Path, PathBuf};

/// Runs the command.
pub(super) fn run(args: &NestArgs, console: Console) -> Result<End, Failure> {
    let first = &args.input[0];
    let name = stem(first);
    if args.check {
        let text = input::text_of(first)?;
        let layout = nest_input::layout(&text, &name).map_err(Failure::of)?;
        return Ok(checked(&layout, console));
    }
    let (mut order, notes) = order(args, &name)?;
    set_up(&mut order, args)?;
    let terminal = Terminal::new(console, args.time_limit);
    let units = args.work.map(|units| units as usize);
    let refused = order.refuse().map_err(Failure::of)?;
    let mut watch = Progress::new(terminal, units, args.snapshot.as_deref(), &order);
    let nested = nested(&mut order, &effort(args), &mut watch);
    watch.terminal.finish();
    let mut nested = nested.map_err(Failure::of)?;
    nested.unplaced.splice(0..0, refused);
    let dir = args.output.clone().unwrap_or_else(|| Path::new("out").join(&order.name));
    let kept = deliver(&order, &nested, args, (&dir, watch.threads()))?;
    kept.iter().for_each(|kept| console.say(&kept.to_string()));
    console.findings(
        &notes.into_iter().chain(left_over(&nested.unplaced)).collect::<Vec<_>>(),
    );
    if let Some(failure) = watch.failure() {
        console.say(&format!("warning: no snapshot: {failure}"));
    }
    console.say(&summary(&nested, args, &dir, watch.terminal.stopped()));
    // What was found so far is written all the same.
    Ok(match () {
        () if watch.terminal.stopped() => End::Interrupted,
        () if nested.unplaced.is_empty() => End::Done,
        () => {
            console.say(&unplaced(&order, nested.unplaced.len()));
            End::Refused
        }
    })
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The parts to nest, and what the drawings they come from did not say.
fn order(args: &NestArgs, name: &str) -> Result<(Order, Vec<Finding>), Failure> {
    let ending = |path: &Path| {
        path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
    };
    let is_drawing = |path: &PathBuf| ["dxf", "svg"].contains(&&*ending(path));
    if !args.input.iter().all(is_drawing) {
        nest_input::only(&args.input.iter().map(|path| stem(path)).collect::<Vec<_>>())
            .map_err(Failure::of)?;
        let order = nest_input::order(&input::text_of(&args.input[0])?, name);
        return Ok((order.map_err(Failure::of)?, Vec::new()));
    }
    let mut drawings = Vec::new();
    for path in &args.input {
        let bytes = input::raw_bytes_of(path)?;
        let drawn = nest_drawing::read(&bytes, ending(path) == "dxf", &args.drawing);
        drawings.push((stem(path), drawn.map_err(Failure::of)?));
    }
    nest_drawing::order(&drawings, &args.drawing).map_err(Failure::of)
}

/// How many sheets all parts would take, if there were as many as needed.
fn unplaced(order: &Order, count: usize) -> String {
    let endless = |stock: &Stock| Stock { count: None, ..stock.clone() };
    let stock: Vec<Stock> = order.stock.iter().map(endless).collect();
    let all =
        nest::search(&order.shapes, &stock, &Effort { trials: 1, seed: 0 }, &mut ());
    let sheets = all.map_or(0, |all| all.layout.sheets.len());
    format!(
        "{count} parts found no place; all that fit a sheet would take {sheets} sheet(s)"
    )
}

/// What could not be placed is a warning: the rest can be cut.
fn left_over(unplaced: &[NestError]) -> Vec<Finding> {
    let warning = |error: &NestError| Finding {
        severity: Severity::Warning,
        ..Finding::new(error, error.place())
    };
    unplaced.iter().map(warning).collect()
}

/// What was typed goes before what the file says.
fn set_up(order: &mut Order, args: &NestArgs) -> Result<(), InputError> {
    let unsaid = order.stock.is_empty() && args.sheet.is_empty();
    if let Some(name) = args.template.as_deref().or(unsaid.then_some("pmma-cast-3")) {
        order.stock = Settings::new(input::template(name)?).stock;
    }
    if !args.sheet.is_empty() {
        let (spacing, margin) =
            order.stock.first().map_or((2.0, 5.0), |s| (s.spacing, s.margin));
        let stock = |&size: &[f64; 2]| Stock::new(size, margin, spacing);
        order.stock = args.sheet.iter().map(stock).collect();
    }
    for stock in &mut order.stock {
        stock.spacing = args.spacing.unwrap_or(stock.spacing);
        stock.margin = args.margin.unwrap_or(stock.margin);
    }
    order.holes_closed = args.no_parts_in_holes;
    Ok(())
}

fn effort(args: &NestArgs) -> Effort {
    let by_level = match args.effort {
        EffortLevel::Quick => 1,
        EffortLevel::Normal => 128,
        EffortLevel::Thorough => 2048,
    };
    // Units that are asked for are counted by the watch: nothing else may end the search.
    let trials = match (args.time_limit, args.work) {
        (None, None) => by_level,
        (None, Some(0 | 1)) => 1,
        _ => u32::MAX,
    };
    Effort { trials, seed: args.seed }
}

fn nested(
    order: &mut Order,
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Nested, NestError> {
    let closed: Vec<Shape>;
    let shapes = if order.holes_closed {
        let solid = |shape: &Shape| Shape { holes: Vec::new(), ..shape.clone() };
        closed = order.shapes.iter().map(solid).collect();
        &closed
    } else {
        &order.shapes
    };
    Ok(match order.task {
        Task::Sheets => {
            let Solution { layout, unplaced, trials } =
                nest::search(shapes, &order.stock, effort, watch)?;
            Nested { layout, unplaced, trials, length: None, seed: effort.seed }
        }
        Task::Strip => {
            let strip = nest::strip(shapes, &order.stock[0], effort, watch)?;
            order.stock[0].width = strip.length;
            let (layout, trials) = (strip.layout, strip.trials);
            let length = Some(strip.length);
            Nested { layout, unplaced: Vec::new(), trials, length, seed: effort.seed }
        }
    })
}

fn deliver(
    order: &Order,
    nested: &Nested,
    args: &NestArgs,
    (dir, threads): (&Path, usize),
) -> Result<Option<Kept>, Failure> {
    let manifest = layout_json(&order.name, &order.shapes, &order.stock, nested);
    let sheets = layout_sheets(&order.shapes, &order.stock, &nested.layout, &order.lines);
    let text = json::text(&manifest).map_err(Failure::of)?;
    let mut files = vec![("layout.json".to_owned(), text.into_bytes())];
    if let Some(approved) =
        approve_loose(&sheets, &[]).filter(|sheets| !sheets.get().is_empty())
    {
        files.extend(export::cut_files(&approved, threads).map_err(Failure::of)?);
    }
    let look = PngLook { px_per_mm: 1.0, ..PngLook::default() };
    for (path, map) in
        free_maps(&order.shapes, &order.stock, &nested.layout, &order.lines)
    {
        files.push((path, export::png(&map, &look).map_err(Failure::of)?));
    }
    let kept = jobdir::write(dir, &files)?;
    if args.json {
        print(&json::line(&manifest).map_err(Failure::of)?);
    }
    Ok(kept)
}

fn summary(nested: &Nested, args: &NestArgs, dir: &Path, stopped: bool) -> String {
    let sheets = nested.layout.sheets.len();
    let parts: usize = nested.layout.sheets.iter().map(|s| s.placements.len()).sum();
    let place = dir.display();
    let what = match nested.length {
        Some(length) => format!("{parts} parts in a strip {length:.3} long in {place}"),
        None => format!("{parts} parts on {sheets} sheet(s) in {place}"),
    };
    let again = format!("; --seed {} --work {} repeats it", args.seed, nested.trials);
    let by_clock = args.time_limit.is_some() || stopped;
    if by_clock { what + &again } else { what }
}

fn checked(order: &Order, console: Console) -> End {
    let Task::Sheets = order.task else { return End::CouldNotRun };
    let faults = nest::check(&order.layout, &order.shapes, &order.stock);
    for fault in &faults {
        Console { quiet: false, ..console }.say(&format!("error: {fault}"));
    }
    if faults.is_empty() {
        console.say("no overlap, and spacing and margin are kept");
        return End::Done;
    }
    End::Refused
}
