//! What services and machines ask of files, as far as it is published (docs/orders.md says
//! where).

use crate::export::{LAYERS, Layer};
use crate::files::FileFormat;

/// What a service or a machine takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile {
    /// As in a template's `output.profile`.
    pub name: &'static str,
    /// Colours of engraving, scores, inner and outer cuts in SVG and PDF.
    pub colours: [[u8; 3]; 4],
    /// The kinds of files it takes.
    pub formats: &'static [FileFormat],
    /// Whether it wants each part in a file of its own.
    pub per_part: bool,
    /// Whether engraving and scores may be in the files.
    pub marks: bool,
    /// Whether the kerf is in the lines; else the service takes it into account.
    pub kerf: bool,
    /// Largest file, mm, if a largest is known.
    pub largest_mm: Option<[f64; 2]>,
    /// Lines nearer to each other burn together, mm.
    pub least_gap_mm: f64,
}

const CYAN: [u8; 3] = [0, 255, 255];
const GREEN: [u8; 3] = [0, 255, 0];
const BLUE: [u8; 3] = [0, 0, 255];
const RED: [u8; 3] = [255, 0, 0];
const BLACK: [u8; 3] = [0, 0, 0];

/// Lines that are 0.5 mm apart or less burn away what is between them.
const BURNS_MM: f64 = 0.5;

const GENERIC: Profile = Profile {
    name: "generic",
    colours: [CYAN, GREEN, BLUE, RED],
    formats: &[FileFormat::Dxf, FileFormat::Svg, FileFormat::Pdf],
    per_part: false,
    marks: true,
    kerf: true,
    largest_mm: None,
    least_gap_mm: BURNS_MM,
};

/// All profiles.
pub const PROFILES: [Profile; 6] = [
    GENERIC,
    // Colours of its palette, so that each becomes a layer of its own: 06, 03, 01, 02.
    Profile {
        name: "lightburn",
        colours: [[0, 224, 224], [0, 224, 0], BLUE, RED],
        formats: &[FileFormat::Svg],
        ..GENERIC
    },
    Profile {
        name: "rgb-lab",
        colours: [BLACK, GREEN, BLUE, RED],
        formats: &[FileFormat::Pdf, FileFormat::Svg],
        ..GENERIC
    },
    Profile {
        name: "snijlab",
        formats: &[FileFormat::Dxf],
        largest_mm: Some([1200.0, 600.0]),
        ..GENERIC
    },
    // Drivers of Epilog and Universal take pure primaries for vectors.
    Profile { name: "epilog", formats: &[FileFormat::Pdf], ..GENERIC },
    Profile {
        name: "single-part",
        formats: &[FileFormat::Dxf],
        per_part: true,
        marks: false,
        kerf: false,
        ..GENERIC
    },
];

impl Profile {
    /// The profile of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        PROFILES.iter().find(|profile| profile.name == name)
    }

    /// The layers in its colours.
    pub fn layers(&self) -> [Layer; 5] {
        let mut layers = LAYERS;
        for (layer, rgb) in layers.iter_mut().zip(self.colours) {
            layer.rgb = rgb;
        }
        layers
    }

    /// Whether its files differ from those that every job has.
    pub fn is_generic(&self) -> bool {
        self.name == GENERIC.name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_profile_of_a_template_is_known_and_tells_its_operations_apart() {
        for name in crate::template::PROFILES {
            let profile = Profile::named(name).unwrap();
            let mut colours = profile.colours.to_vec();
            colours.sort_unstable();
            colours.dedup();
            assert_eq!(colours.len(), 4, "{name}");
        }
        assert_eq!(crate::template::PROFILES.len(), PROFILES.len());
    }
}
