//! The page and the guide: whole, offline, and about this very job.
#![allow(clippy::unwrap_used, reason = "a test that cannot be set up has failed")]

use finwright::design::examples;
use finwright::fabrication::{Fabrication, fabricate};
use finwright::joint::Joint;
use finwright::nest::Effort;
use finwright::report::{self, JobSource, Page};
use finwright::settings::Settings;
use finwright::structure::Draft;
use finwright::template::{self, Template};
use serde_json::Value;

fn template() -> Template {
    let name = "pmma-cast-3";
    template::read(template::embedded(name).unwrap(), name).unwrap()
}

fn made(draft: Draft, joint: Joint, template: &Template) -> Fabrication {
    let effort = Effort { trials: 1, seed: 0 };
    let settings = Settings { joint, effort, ..Settings::new(template.clone()) };
    fabricate(draft, settings, &mut ()).unwrap()
}

fn source(template: &Template, joint: Joint) -> JobSource<'_> {
    JobSource {
        input: "example",
        input_sha256: "",
        template,
        template_sha256: "",
        seed: 0,
        scale: "1:1",
        joint,
    }
}

fn page_of(job: &Fabrication, source: &JobSource, is_approved: bool) -> String {
    let manifest = report::manifest(job, source);
    report::page(&Page { job, source, manifest: &manifest, proof: None, is_approved })
}

fn example(name: &str) -> Draft {
    (examples::named(name).unwrap().draft)()
}

/// The numbers for the view, as the page's script reads them.
fn scene(page: &str) -> Value {
    let start = page.find("id=\"scene\">").unwrap() + "id=\"scene\">".len();
    let end = start + page[start..].find("</script>").unwrap();
    serde_json::from_str(&page[start..end]).unwrap()
}

#[test]
fn the_page_loads_nothing_and_shows_every_part_in_space_on_a_sheet_and_as_a_step() {
    let template = template();
    let job = made(example("vault"), Joint::Lap, &template);
    let page = page_of(&job, &source(&template, Joint::Lap), true);
    for word in ["http:", "https:", "//cdn", " src=", "@import", "<link", "url("] {
        assert!(!page.contains(word), "{word}");
    }
    let scene = scene(&page);
    let fins = scene["fins"].as_array().unwrap();
    assert_eq!(fins.len(), job.structure.as_ref().unwrap().fins().len());
    assert_eq!(scene["motion"].as_array().unwrap().len(), fins.len());
    for (index, part) in job.parts.iter().enumerate() {
        assert!(fins.iter().any(|fin| fin[2] == index), "{} in space", part.id);
        let on_sheet = format!("<g class=\"part\" data-part=\"{}\"", part.id);
        assert_eq!(page.matches(&on_sheet).count(), 1);
        assert!(page.contains(&format!(
            "aria-label=\"step {}: {} goes in",
            index + 1,
            part.id
        )));
    }
    let bends = page.find("Tightest bend of each part").unwrap();
    assert!(
        page[bends..].contains("weeks, as a model"),
        "the vault bends at R = 100 to 330 t"
    );
    let figures = page.matches("<figure").count();
    assert_eq!(page.matches("aria-label=\"step ").count(), figures - job.sheets.len());
}

#[test]
fn corners_move_with_their_part_in_the_softest_motion() {
    let template = template();
    let job = made(example("dome"), Joint::Lap, &template);
    let scene = scene(&page_of(&job, &source(&template, Joint::Lap), true));
    let structure = job.structure.as_ref().unwrap();
    // A rigid body stretches nothing: along a fin's edge both ends move alike.
    let mut fastest: f64 = 0.0;
    for (fin, moved) in structure.fins().iter().zip(scene["motion"].as_array().unwrap()) {
        let moved: Vec<f64> =
            moved.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        let [a, b, ..] = structure.corners(fin.ends());
        let along = (b - a).normalize();
        let speed = |k: usize| {
            along.dot(&finwright::geometry::Vector3::from_row_slice(&moved[k..k + 3]))
        };
        assert!((speed(0) - speed(6)).abs() < 2e-3, "{fin:?}");
        fastest = moved.iter().fold(fastest, |most, x| most.max(x.abs()));
    }
    assert!(fastest > 0.5 && fastest <= 1.0, "{fastest}");
}

#[test]
fn the_page_of_a_refused_job_says_so_and_shows_what_there_is() {
    let template = template();
    let job = made(example("vault"), Joint::Hinge, &template);
    let page = page_of(&job, &source(&template, Joint::Hinge), false);
    assert!(page.contains("Not for cutting"));
    assert!(page.contains("<strong>flexible</strong>"));
    // Its axes are too short for eight plates, but the fins are there to be looked at.
    assert!(page.contains("parts::axis_too_short"));
    assert!(scene(&page)["fins"].as_array().unwrap().iter().all(|fin| fin[2] != -1));
    let nothing = Fabrication::new(Settings::new(template.clone()));
    let page = page_of(&nothing, &source(&template, Joint::Lap), false);
    assert!(page.contains("There is no structure to show."));
}

#[test]
fn names_cannot_break_out_of_the_page() {
    let template = template();
    let mut draft = example("three");
    draft.name = "</title><script>alert(1)</script>".into();
    let job = made(draft, Joint::Lap, &template);
    let page = page_of(&job, &source(&template, Joint::Lap), true);
    assert!(!page.contains("<script>alert"));
    assert!(page.contains("&lt;/title&gt;&lt;script&gt;alert(1)"));
}

/// A title, six figures to a page, and the list of parts; every part is named twice.
#[test]
fn the_guide_has_a_figure_for_each_step_and_names_each_part() {
    let template = template();
    let job = made(example("vault"), Joint::Lap, &template);
    let bytes = report::guide(&job, &source(&template, Joint::Lap)).unwrap();
    let guide = lopdf::Document::load_mem(&bytes).unwrap();
    let pages = guide.get_pages();
    let steps = job.parts.len();
    assert_eq!(pages.len(), 1 + steps.div_ceil(6) + 1);
    let numbers: Vec<u32> = pages.keys().copied().collect();
    let text = guide.extract_text(&numbers).unwrap();
    let words: Vec<&str> = text.split_whitespace().collect();
    for part in &job.parts {
        let named = words.iter().filter(|word| **word == part.id).count();
        assert!(named >= 2, "{} is named {named} times", part.id);
    }
    let nothing = Fabrication::new(Settings::new(template.clone()));
    assert!(report::guide(&nothing, &source(&template, Joint::Lap)).is_none());
}
