//! Valid texts, spoilt by a seeded generator, and what has to hold for each.
//!
//! Used by the fuzz run (`tests/fuzz/spoil.rs`) and, for a few hundred seeds, by the suite.

use finwright::diagnostic::{Severity, passes};
use finwright::export::PngLook;
use finwright::fabrication::{Fabrication, fabricate};
use finwright::nest::Effort;
use finwright::settings::Settings;
use finwright::sheets::Path;
use finwright::structure::{
    AxisRule, Draft, ObjOptions, Structure, read_json, read_obj, write_json, write_obj,
};
use finwright::template::{self, Template};
use finwright::tolerance::Tolerance;
use finwright::units::Unit;
use finwright::{export, report};

#[path = "valid.rs"]
mod valid;

use valid::{crossed, embedded, grid, offcuts, ring, without_strips};

/// A kind of text that finwright reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Json,
    Obj,
    Template,
}

/// A spoilt text.
pub(crate) struct Spoilt {
    pub(crate) kind: Kind,
    pub(crate) text: String,
    /// Which of the templates a structure is cut by.
    pub(crate) template: usize,
}

/// How far a spoilt text came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Outcome {
    /// A reader refused it.
    Unread,
    /// It is no structure.
    NoStructure,
    /// It has error findings.
    Refused,
    /// It was cut.
    Cut,
}

/// splitmix64.
pub(crate) struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.roll() % count.max(1) as u64) as usize
    }

    fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

/// The texts that are spoilt.
pub(crate) struct Valid {
    texts: Vec<(Kind, String)>,
    templates: Vec<Template>,
}

impl Valid {
    pub(crate) fn new() -> Self {
        let structures: Vec<Structure> = [grid(3, 3), grid(2, 5), ring(7), crossed()]
            .into_iter()
            .map(|draft| Structure::new(draft, &Tolerance::default()).unwrap().0)
            .collect();
        let json = structures.iter().map(|s| (Kind::Json, write_json(s)));
        let plain =
            structures.iter().map(|s| (Kind::Json, without_strips(&write_json(s))));
        let obj = structures.iter().map(|s| (Kind::Obj, write_obj(s)));
        let names = ["pmma-cast-3", "card-1.5"];
        let templates = names.map(|name| (Kind::Template, embedded(name)));
        let texts = json.chain(plain).chain(obj).chain(templates).collect();
        let templates = ["card-1.5", "pmma-cast-3"]
            .map(|name| template::read(&embedded(name), name).unwrap());
        Self { texts, templates: templates.into_iter().chain([offcuts()]).collect() }
    }

    /// The spoilt text of a seed.
    pub(crate) fn spoilt(&self, seed: u64) -> Spoilt {
        let mut dice = Dice(seed);
        let (kind, text) = dice.pick(&self.texts);
        let mut text = text.clone();
        // Half the cases stay readable, so that they come to the later stages.
        let spoil = *dice.pick(&[spoil as fn(&str, &mut Dice) -> String, spoil_mildly]);
        for _ in 0..=dice.below(2) {
            text = spoil(&text, &mut dice);
        }
        Spoilt { kind: *kind, text, template: dice.below(self.templates.len()) }
    }

    /// Takes a text through its reader and all stages.
    ///
    /// # Panics
    /// If something that must hold does not.
    pub(crate) fn run(&self, spoilt: &Spoilt) -> Outcome {
        let text = spoilt.text.as_str();
        let template = &self.templates[spoilt.template];
        match spoilt.kind {
            Kind::Json => match read_json(text, AxisRule::File) {
                Ok((draft, _)) => self.make(draft, template),
                Err(_) => Outcome::Unread,
            },
            Kind::Obj => {
                let options = ObjOptions {
                    unit: Unit::Millimetre,
                    axes: AxisRule::File,
                    weld_mm: 0.0,
                };
                match read_obj(text, &options) {
                    Ok((draft, _)) => self.make(draft, template),
                    Err(_) => Outcome::Unread,
                }
            }
            Kind::Template => match template::read(text, "spoilt") {
                Ok(template) => self.make(grid(3, 3), &template),
                Err(_) => Outcome::Unread,
            },
        }
    }

    fn make(&self, draft: Draft, template: &Template) -> Outcome {
        let effort = Effort { trials: 1, seed: 0 };
        let settings = Settings { effort, ..Settings::new(template.clone()) };
        let job = fabricate(draft, settings, &mut ()).unwrap();
        for finding in &job.findings {
            let said = [&finding.code, &finding.message, &finding.help];
            assert!(said.iter().all(|text| !text.is_empty()), "{finding:?}");
            assert!(finding.message.len() < 300, "{finding:?}");
        }
        assert_explained(&job);
        if job.structure.is_none() {
            return Outcome::NoStructure;
        }
        let _ = report::bill(&job, &template.material.name);
        match job.approved() {
            Ok(sheets) => {
                assert_finite(&job);
                let look = PngLook { px_per_mm: 0.2, ..PngLook::default() };
                for sheet in *sheets.get() {
                    assert!(!export::dxf(sheet).is_empty());
                    assert!(!export::svg(sheet).is_empty());
                    assert!(export::png(sheet, &look).is_ok());
                }
                assert!(!export::pdf(sheets.get()).is_empty());
                Outcome::Cut
            }
            Err(_) => Outcome::Refused,
        }
    }
}

/// A layout that is unsound for no reason that the user was told of is our fault.
fn assert_explained(job: &Fabrication) {
    let unsound = job.findings.iter().any(|finding| finding.code == "nest::unsound");
    let errors = job.findings.iter().filter(|f| f.severity == Severity::Error).count();
    assert!(!unsound || errors > 1, "unsound without a reason: {:?}", job.findings);
    assert!(passes(&job.findings) || errors > 0);
}

/// What goes to the laser is made of numbers.
fn assert_finite(job: &Fabrication) {
    assert!(!job.sheets.is_empty());
    for stroke in job.sheets.iter().flat_map(|sheet| &sheet.strokes) {
        let finite = match &stroke.path {
            Path::Open(points) => {
                points.iter().all(|p| p.coords.iter().all(|x| x.is_finite()))
            }
            Path::Closed(contour) => contour.vertices.iter().all(|v| {
                v.bulge.is_finite() && v.point.coords.iter().all(|x| x.is_finite())
            }),
        };
        assert!(finite, "{stroke:?}");
    }
}

/// Numbers that have broken programs before.
const NASTY: [&str; 30] = [
    "0",
    "-0",
    "-0.0",
    "1",
    "-1",
    "2",
    "0.5",
    "1e308",
    "-1e308",
    "1e999",
    "nan",
    "NaN",
    "inf",
    "-inf",
    "1e-300",
    "1e-9",
    "1e9",
    "999999999.9",
    "1e15",
    "1e100",
    "4294967296",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775808",
    "0x10",
    "1,5",
    "",
    "90",
    "1e-6",
    "60.0000001",
];

/// Changes that leave a text readable: numbers by other finite numbers.
fn spoil_mildly(text: &str, dice: &mut Dice) -> String {
    match dice.below(4) {
        0 => swapped(text, dice),
        1 => moved_far(text, dice),
        _ => replaced(text, dice, nudged),
    }
}

fn spoil(text: &str, dice: &mut Dice) -> String {
    match dice.below(12) {
        0..=3 => replaced(text, dice, |_, dice| (*dice.pick(&NASTY)).to_owned()),
        4..=5 => replaced(text, dice, nudged),
        6 => swapped(text, dice),
        7 => byte_flipped(text, dice),
        8..=9 => line_changed(text, dice),
        10 => deleted(text, dice),
        _ => moved_far(text, dice),
    }
}

/// The places of all numbers.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (at, byte) in text.bytes().enumerate() {
        let is_number = byte.is_ascii_digit() || b"+-.eE".contains(&byte);
        match (start, is_number) {
            (None, true) if byte.is_ascii_digit() || byte == b'-' => start = Some(at),
            (Some(from), false) => {
                found.push(from..at);
                start = None;
            }
            _ => {}
        }
    }
    found
}

fn replaced(
    text: &str,
    dice: &mut Dice,
    by: impl Fn(&str, &mut Dice) -> String,
) -> String {
    let numbers = numbers(text);
    if numbers.is_empty() {
        return text.to_owned();
    }
    let mut text = text.to_owned();
    let range = dice.pick(&numbers).clone();
    let new = by(&text[range.clone()], dice);
    text.replace_range(range, &new);
    text
}

/// A number that is a little off, or by a whole factor.
fn nudged(old: &str, dice: &mut Dice) -> String {
    let Ok(number) = old.parse::<f64>() else { return old.to_owned() };
    match dice.below(6) {
        0 => format!("{}", -number),
        1 => format!("{}", number * 10.0),
        2 => format!("{}", number * 1e-3),
        3 => format!("{}", number + 1.0),
        4 => format!("{}", number + dice.below(200) as f64 - 100.0),
        _ => format!("{}", number * (1.0 + 1e-9)),
    }
}

/// One number where another was.
fn swapped(text: &str, dice: &mut Dice) -> String {
    let all = numbers(text);
    let source =
        all.get(dice.below(all.len())).map(|range| text[range.clone()].to_owned());
    replaced(text, dice, |old, _| source.clone().unwrap_or_else(|| old.to_owned()))
}

fn byte_flipped(text: &str, dice: &mut Dice) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let at = dice.below(bytes.len());
    if let Some(byte) = bytes.get_mut(at) {
        *byte ^= 1 << dice.below(8);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A line dropped, doubled, moved to the end, or everything after it lost.
fn line_changed(text: &str, dice: &mut Dice) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let at = dice.below(lines.len());
    if lines.is_empty() {
        return String::new();
    }
    match dice.below(8) {
        0..=2 => drop(lines.remove(at)),
        3..=4 => lines.insert(at, lines[at]),
        5..=6 => {
            let line = lines.remove(at);
            lines.push(line);
        }
        _ => lines.truncate(at),
    }
    lines.join("\n")
}

/// A few characters lost.
fn deleted(text: &str, dice: &mut Dice) -> String {
    let characters: Vec<char> = text.chars().collect();
    let at = dice.below(characters.len());
    let after = (at + 1 + dice.below(12)).min(characters.len());
    characters.iter().take(at).chain(&characters[after..]).collect()
}

/// Many numbers at once: a tenth of them nasty.
fn moved_far(text: &str, dice: &mut Dice) -> String {
    let mut text = text.to_owned();
    for range in numbers(&text).into_iter().rev() {
        if dice.below(10) == 0 {
            let new = nudged(&text[range.clone()], dice);
            text.replace_range(range, &new);
        }
    }
    text
}
