//! The formats that sheets are written in, where files stand in a job directory, and the
//! digest by which what they hold is known again.
//!
//! Who adds a format touches three places: its name here, its writer in
//! [`export`](crate::export), its reader among those that [`proof`](crate::proof) lists.

use sha2::{Digest, Sha256};

/// Folder of the sheets.
pub const SHEETS: &str = "sheets";

/// Folder of the files for a service or machine.
pub const ORDER: &str = "order";

/// Folder of stamped pictures of sheets that were refused.
pub const PREVIEW: &str = "preview";

/// A format of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileFormat {
    /// DXF R12.
    Dxf,
    /// SVG.
    Svg,
    /// PDF, a page per sheet.
    Pdf,
    /// PNG: a picture, never for a laser.
    Png,
}

impl FileFormat {
    /// Those for the laser, in the order in which they are written and proved.
    pub const CUT: [Self; 3] = [Self::Dxf, Self::Svg, Self::Pdf];

    /// How names of files end, and its key in manifests.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dxf => "dxf",
            Self::Svg => "svg",
            Self::Pdf => "pdf",
            Self::Png => "png",
        }
    }

    /// Whether one file holds all sheets.
    pub const fn holds_all_sheets(self) -> bool {
        matches!(self, Self::Pdf)
    }

    /// Path of the file of a sheet in this folder, or of the file of all its sheets.
    pub fn path(self, folder: &str, sheet: &str) -> String {
        let stem = if self.holds_all_sheets() { "sheets" } else { sheet };
        format!("{folder}/{stem}.{}", self.name())
    }

    /// Whether a file is for the laser, by its name.
    pub fn is_cut(path: &str) -> bool {
        let ending = path.rsplit_once('.').map(|(_, ending)| ending);
        Self::CUT.iter().any(|format| ending == Some(format.name()))
    }
}

/// SHA-256 of what a file holds, hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sheet_has_its_files_and_all_have_one_pdf() {
        let paths = FileFormat::CUT.map(|format| format.path(SHEETS, "sheet-02"));
        assert_eq!(
            paths,
            ["sheets/sheet-02.dxf", "sheets/sheet-02.svg", "sheets/sheets.pdf"]
        );
        assert!(paths.iter().all(|path| FileFormat::is_cut(path)));
        assert!(!FileFormat::is_cut(&FileFormat::Png.path(PREVIEW, "sheet-01")));
    }
}
