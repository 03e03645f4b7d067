//! finwright: from a torsion-free support structure to laser-cut sheets.
//!
//! The stages in order, each a pure function on plain values:
//!
//! 1. [`structure`]: a [`Draft`](structure::Draft) is judged and becomes a
//!    [`Structure`](structure::Structure): nodes with axes, planar fins, strips of fins.
//! 2. [`rigidity`]: rigid or flexible, as a verdict.
//! 3. [`parts`]: strips are unfolded, slit where they cross, spliced and marked.
//! 4. [`nest`]: parts find their places on sheets of the stock; [`drawing`] reads parts
//!    that others drew.
//! 5. [`sheets`]: what the laser does, kerf included, independent of any format.
//! 6. [`gate`]: only what nothing forbids, the verdict first, is [`Approved`](gate::Approved).
//! 7. [`export`]: DXF, SVG, PDF and PNG. [`report`]: the manifest and the bill of parts.
//! 8. [`proof`]: the written bytes back to parts, folded and compared with the structure.
//!
//! [`fabrication`] runs them as far as sheets, [`job`] all of them: from a specification to
//! everything that a job directory holds. `cli` is the only room that touches the world.
//! Units are millimetres and radians inside.
//!
//! ```
//! use finwright::{design::examples, job, settings::Settings, template};
//!
//! let source = template::embedded("pmma-cast-3").unwrap();
//! let template = template::read(source, "pmma-cast-3").unwrap();
//! let specification = job::Specification {
//!     input: job::Input::embedded(examples::named("three").unwrap(), &job::InputOptions::default()),
//!     settings: Settings::new(template),
//!     planarise: true,
//!     apply_remedies: false,
//!     only: Vec::new(),
//! };
//! let job = job::make(specification, &mut ()).unwrap();
//! assert_eq!(job.end, job::End::Approved);
//! assert!(job.files.iter().any(|(path, _)| path == "sheets/sheet-01.dxf"));
//! assert!(job.files.iter().any(|(path, _)| path == "report.html"));
//! ```

#[cfg(feature = "cli")]
pub mod cli;
pub mod design;
pub mod diagnostic;
pub mod drawing;
pub mod export;
pub mod fabrication;
pub mod files;
pub mod gate;
pub mod geometry;
pub mod ids;
pub mod job;
pub mod joint;
pub mod json;
pub mod lettering;
pub mod manifest;
pub mod nest;
pub mod parts;
pub mod picture;
pub mod proof;
pub mod report;
pub mod rigidity;
pub mod settings;
pub mod sheets;
pub mod sparse;
pub mod structure;
pub mod template;
pub mod tolerance;
pub mod units;
pub mod vendor;
pub mod watch;
