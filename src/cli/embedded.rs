//! `template` and `example`: what is embedded in the program.

use crate::cli::flags::{ExampleAction, TemplateAction};
use crate::cli::input::{self, InputError};
use crate::cli::jobdir::JobDirError;
use crate::cli::outcome::{End, Failure, print};
use crate::design::{ReferenceSurface, SURFACES, examples, surface_named};
use crate::structure::{Structure, write_json};
use crate::template;
use crate::tolerance::Tolerance;
use std::io::Write;

pub(super) fn templates(action: TemplateAction) -> Result<End, Failure> {
    match action {
        TemplateAction::List => {
            let line = |name: &&str| {
                let read =
                    template::embedded(name).and_then(|s| template::read(s, name).ok());
                let about =
                    read.map(|template| template.material.name).unwrap_or_default();
                format!("{name:14} {about}\n")
            };
            Ok(print(&template::names().iter().map(line).collect::<String>()))
        }
        TemplateAction::Show { name } => match template::embedded(&name) {
            Some(source) => Ok(print(source)),
            None => Err(InputError::BadTemplate(template::unknown_name(&name)).into()),
        },
        TemplateAction::Check { file } => {
            input::template(&file.to_string_lossy())?;
            let _ = writeln!(std::io::stderr(), "{}: nothing wrong", file.display());
            Ok(End::Done)
        }
    }
}

pub(super) fn example(action: ExampleAction) -> Result<End, Failure> {
    match action {
        ExampleAction::List => {
            let line = |e: &examples::Example| format!("{:14} {}\n", e.name, e.about);
            let surface = |s: &ReferenceSurface| format!("{:14} {}\n", s.name, s.about);
            let structures = examples::ALL.iter().map(line);
            let all = structures.chain(SURFACES.iter().map(surface));
            Ok(print(&all.collect::<String>()))
        }
        ExampleAction::Write { name, output } => {
            let Some(text) = example_text(&name) else {
                return Err(input::unknown_structure(&name).into());
            };
            let Some(path) = output else { return Ok(print(&text)) };
            std::fs::write(&path, text)
                .map_err(|source| JobDirError::Disk { path, source })?;
            Ok(End::Done)
        }
    }
}

/// An embedded structure as JSON, or surface as OBJ.
fn example_text(name: &str) -> Option<String> {
    if let Some(surface) = surface_named(name) {
        return Some((surface.polygons)().obj(surface.about));
    }
    let example = examples::named(name)?;
    let (structure, _) = Structure::new((example.draft)(), &Tolerance::default()).ok()?;
    Some(write_json(&structure))
}
