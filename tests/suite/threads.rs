//! On how many threads a job is made is not seen in its bytes.

use finwright::design::examples;
use finwright::job::{self, Input, InputOptions, Specification};
use finwright::joint::Joint;
use finwright::nest::Effort;
use finwright::settings::Settings;
use finwright::template;
use finwright::watch::Watch;

/// Lets so many threads work.
struct Threads(usize);

impl Watch for Threads {
    fn progress(&mut self, _stage: &'static str, _done: usize, _total: usize) {}

    fn stopped(&self) -> bool {
        false
    }

    fn threads(&self) -> usize {
        self.0
    }
}

/// All files of a job of an embedded structure.
fn files(name: &str, joint: Joint, threads: usize) -> Vec<(String, Vec<u8>)> {
    let source = template::embedded("pmma-cast-3").unwrap();
    let template = template::read(source, "pmma-cast-3").unwrap();
    let input = Input::embedded(examples::named(name).unwrap(), &InputOptions::default());
    let settings = Settings {
        joint,
        effort: Effort { trials: 2, seed: 1 },
        ..Settings::new(template)
    };
    let specification = Specification {
        input,
        settings,
        planarise: true,
        apply_remedies: false,
        only: Vec::new(),
    };
    job::make(specification, &mut Threads(threads)).unwrap().files
}

#[test]
fn a_job_has_the_same_bytes_on_one_thread_and_on_two() {
    for (name, joint) in [("vault", Joint::Lap), ("three", Joint::Hub)] {
        let one = files(name, joint, 1);
        assert!(one.iter().any(|(path, _)| path == "report.html"));
        let two = files(name, joint, 2);
        assert_eq!(one.len(), two.len(), "{name}");
        for ((path, bytes), (_, others)) in one.iter().zip(&two) {
            assert!(bytes == others, "{name}: {path} differs on two threads");
        }
    }
}
