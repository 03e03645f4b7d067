//! `finwright nest`: parts of any origin onto sheets, or into a strip.

use crate::cli::args::EffortLevel;
use crate::cli::input::{self, InputError};
use crate::cli::jobdir::{self, JobFile};
use crate::cli::nest_drawing;
use crate::cli::nest_input::{self, Order, Task};
use crate::cli::nest_progress::Progress;
use crate::cli::run::{End, Failure};
use crate::cli::show::{Terminal, Voice};
use crate::diagnostic::{Finding, Located, Severity};
use crate::export::{self, PngLook};
use crate::gate::approve_loose;
use crate::nest::{self, Effort, Found, NestError, Shape, Stock};
use crate::proof::{Format, drawn_parts};
use crate::report::{Nested, free_maps, layout_json, layout_sheets};
use crate::setting;
use crate::sheets::Sheet;
use crate::watch::Watch;
use clap::Args;
use std::path::{Path, PathBuf};

/// Shown after the help of `nest`.
pub(super) const HELP: &str = "\
Examples:
  finwright nest parts.json -o out/parts
      parts on the sheets that the file names
  finwright nest drawing.dxf -t pmma-cast-3
      the closed lines of a drawing with what is engraved on them, on the template's sheets
  finwright nest parts.json --sheet 600x400 --sheet 1000x600 --spacing 2 --margin 5
      on sheets of two sizes, as many of each as needed; the smaller one is tried first
  finwright nest swim.json --time-limit 60
      a strip-packing instance; the units of work that repeat the result are printed
  finwright nest --check out/parts/layout.json
      whether parts overlap, come too near, or reach into the margin";

/// Arguments of `nest`.
#[derive(Debug, Args)]
pub struct NestArgs {
    /// Parts to nest: a drawing (.dxf, .svg), or a finwright-parts or strip-packing file
    /// (.json)
    pub input: PathBuf,

    /// Only check a layout.json that was written before
    #[arg(long)]
    pub check: bool,

    /// Take the sheets of this template [default: as the file says, else pmma-cast-3]
    #[arg(short, long, value_name = "TEMPLATE", conflicts_with = "sheet")]
    pub template: Option<String>,

    /// Size of a sheet in mm; may be given more than once
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub sheet: Vec<[f64; 2]>,

    /// Least distance between parts, mm [default: as the file says, else 2 on sheets and 0
    /// in strips]
    #[arg(long, value_name = "MM", value_parser = length)]
    pub spacing: Option<f64>,

    /// Free strip along the sheet's edge, mm [default: as the file says, else 5 on sheets
    /// and 0 in strips]
    #[arg(long, value_name = "MM", value_parser = length)]
    pub margin: Option<f64>,

    /// Keep holes of parts free
    #[arg(long)]
    pub no_parts_in_holes: bool,

    /// Folder for layout and sheets [default: out/<name>]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Seed of the search
    #[arg(long, default_value_t = 0)]
    pub seed: u64,

    /// How hard to search
    #[arg(long, value_enum, default_value = "normal")]
    pub effort: EffortLevel,

    /// Search for this many units of work instead
    #[arg(long, value_name = "UNITS", conflicts_with_all = ["effort", "time_limit"])]
    pub work: Option<u32>,

    /// Search for this long instead; prints the units of work that repeat the result
    #[arg(long, value_name = "SECONDS", conflicts_with = "effort",
          value_parser = super::args::seconds)]
    pub time_limit: Option<f64>,

    /// Keep a picture (PNG) of the best layout so far here while searching
    #[arg(long, value_name = "FILE")]
    pub snapshot: Option<PathBuf>,

    /// Print layout.json on standard output
    #[arg(long)]
    pub json: bool,
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(mm) if (0.0..=1e6).contains(&mm) => Ok(mm),
        _ => Err(format!("{text:?} is no length in mm")),
    }
}

fn size(text: &str) -> Result<[f64; 2], String> {
    let wrong = || format!("{text:?} is no size; write 600x400 for 600 by 400 mm");
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    match (length(width)?, length(height)?) {
        (width, height) if width > 0.0 && height > 0.0 => Ok([width, height]),
        _ => Err(wrong()),
    }
}

/// Runs the command.
pub(super) fn run(args: &NestArgs, voice: Voice) -> Result<End, Failure> {
    let name = args.input.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let wrong = |source| Failure::Other(Box::new(source));
    if args.check {
        let text = input::text_of(&args.input)?;
        let layout = nest_input::layout(&text, &name).map_err(wrong)?;
        return Ok(checked(&layout, voice));
    }
    let (mut order, notes) = order(args, &name)?;
    set_up(&mut order, args)?;
    let terminal = Terminal::new(voice, args.time_limit);
    let units = args.work.map(|units| units as usize);
    let failed = |error: NestError| Failure::Other(Box::new(error));
    let refused = order.refuse().map_err(failed)?;
    let mut watch = Progress::new(terminal, units, args.snapshot.as_deref(), &order);
    let nested = nested(&mut order, &effort(args), &mut watch);
    watch.terminal.finish();
    let mut nested = nested.map_err(failed)?;
    nested.unplaced.splice(0..0, refused);
    let dir = args.output.clone().unwrap_or_else(|| Path::new("out").join(&order.name));
    deliver(&order, &nested, args, &dir)?;
    voice.findings(
        &notes.into_iter().chain(left_over(&nested.unplaced)).collect::<Vec<_>>(),
    );
    if let Some(failure) = watch.failure() {
        voice.say(&format!("warning: no snapshot: {failure}"));
    }
    voice.say(&summary(&nested, args, &dir, watch.terminal.stopped()));
    // What was found so far is written all the same.
    Ok(if watch.terminal.stopped() { End::Interrupted } else { End::Done })
}

/// The parts to nest, and what the drawing they come from did not say.
fn order(args: &NestArgs, name: &str) -> Result<(Order, Vec<Finding>), Failure> {
    let ending = args.input.extension().unwrap_or_default().to_string_lossy();
    let format = match ending.to_lowercase().as_str() {
        "dxf" => Format::Dxf,
        "svg" => Format::Svg,
        _ => {
            let text = input::text_of(&args.input)?;
            let order = nest_input::order(&text, name);
            return Ok((order.map_err(|e| Failure::Other(Box::new(e)))?, Vec::new()));
        }
    };
    let drawn = drawn_parts(&input::bytes_of(&args.input)?, format)
        .map_err(|error| Failure::Other(Box::new(error)))?;
    let (order, notes) = nest_drawing::order(&drawn, name)
        .map_err(|error| Failure::Other(Box::new(error)))?;
    Ok((order, notes))
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
        let template = input::template(name)?;
        order.stock = setting::stock(&template);
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
            let Found { layout, unplaced, trials } =
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
    dir: &Path,
) -> Result<(), Failure> {
    let manifest = layout_json(&order.name, &order.shapes, &order.stock, nested);
    let sheets = layout_sheets(&order.shapes, &order.stock, &nested.layout, &order.lines);
    let text = serde_json::to_string_pretty(&manifest).unwrap_or_default() + "\n";
    let mut files =
        vec![JobFile { path: "layout.json".into(), bytes: text.into_bytes() }];
    if let Some(approved) =
        approve_loose(&sheets, &[]).filter(|sheets| !sheets.get().is_empty())
    {
        let cut = export::cut_files(&approved).into_iter();
        files.extend(cut.map(|(path, bytes)| JobFile { path, bytes }));
    }
    let maps = free_maps(&order.shapes, &order.stock, &nested.layout, &order.lines);
    let picture = |(path, map): (String, Sheet)| {
        let bytes = export::png(&map, &PngLook { px_per_mm: 1.0, ..PngLook::default() });
        bytes.ok().map(|bytes| JobFile { path, bytes })
    };
    files.extend(maps.into_iter().filter_map(picture));
    jobdir::write(dir, &files)?;
    if args.json {
        crate::cli::run::print(&format!("{manifest}\n"));
    }
    Ok(())
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

fn checked(order: &Order, voice: Voice) -> End {
    let Task::Sheets = order.task else { return End::CouldNotRun };
    let faults = nest::check(&order.layout, &order.shapes, &order.stock);
    for fault in &faults {
        Voice { quiet: false, ..voice }.say(&format!("error: {fault}"));
    }
    if faults.is_empty() {
        voice.say("no overlap, and spacing and margin are kept");
        return End::Done;
    }
    End::Refused
}
