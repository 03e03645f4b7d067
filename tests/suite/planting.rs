//! Jobs that `make` wrote, taken apart so that faults can be planted in copies.

use finwright::diagnostic::{Finding, passes};
use finwright::geometry::{Contour, Point2, Vector2, Vertex};
use finwright::proof::{JobFiles, Proof, prove};
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

pub(crate) const DXF: &str = "sheets/sheet-01.dxf";

/// The files of a job that `make` wrote.
pub(crate) fn job(name: &str) -> JobFiles {
    let place = tempfile::tempdir().unwrap();
    let dir = place.path().join("job");
    let words = ["make"].into_iter().chain(name.split(' '));
    let words: Vec<&str> = words.chain(["-q", "--effort", "quick"]).collect();
    let accepted = ["--accept-flexible", "for the proof", "-o"];
    let words = [words.as_slice(), accepted.as_slice()].concat();
    assert_eq!(finwright(&words, &dir), Some(0));
    let mut files = JobFiles::new();
    for folder in ["", "sheets/"] {
        for entry in std::fs::read_dir(dir.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() && path.extension().is_some_and(|end| end != "png") {
                let name = path.file_name().unwrap().to_string_lossy();
                files.insert(format!("{folder}{name}"), std::fs::read(&path).unwrap());
            }
        }
    }
    files
}

pub(crate) fn finwright(args: &[&str], dir: &Path) -> Option<i32> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_finwright"));
    command.args(args).arg(dir).output().unwrap().status.code()
}

/// The job that faults are planted in; made once.
pub(crate) fn vault() -> JobFiles {
    static VAULT: OnceLock<JobFiles> = OnceLock::new();
    VAULT.get_or_init(|| job("vault")).clone()
}

/// A polyline of a DXF file of ours.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) layer: String,
    pub(crate) closed: bool,
    pub(crate) contour: Contour,
}

impl Line {
    pub(crate) fn middle(&self) -> Point2 {
        let points = || self.contour.vertices.iter().map(|vertex| vertex.point);
        let low = points().reduce(|a, b| a.inf(&b)).unwrap();
        nalgebra::center(&low, &points().reduce(|a, b| a.sup(&b)).unwrap())
    }

    pub(crate) fn shift(&mut self, by: Vector2) {
        self.contour = self.contour.moved(|p| p + by);
    }
}

/// A job whose first sheet is taken apart so that a fault can be planted.
pub(crate) struct Planting {
    pub(crate) files: JobFiles,
    pub(crate) manifest: Value,
    pub(crate) lines: Vec<Line>,
}

impl Planting {
    pub(crate) fn new() -> Self {
        Self::of(vault())
    }

    pub(crate) fn of(files: JobFiles) -> Self {
        let manifest = serde_json::from_slice(&files["job.json"]).unwrap();
        let lines = read_lines(&files[DXF]);
        Self { files, manifest, lines }
    }

    /// The outline of a part of the first sheet, by its place in the manifest's list.
    pub(crate) fn outline(&mut self, nth: usize) -> (String, &mut Line) {
        let (id, at) = self.placed(nth);
        let off = |line: &Line| (line.middle() - at).norm();
        let outer = self.lines.iter_mut().filter(|line| line.layer == "CUT_OUTER");
        (id, outer.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap())
    }

    /// Name of a placed part and the middle of its place.
    pub(crate) fn placed(&self, nth: usize) -> (String, Point2) {
        let id = self.placement(nth)["part"].as_str().unwrap().to_owned();
        let outline = self.part(&id)["outline"].as_array().unwrap();
        let points = outline.iter().map(|p| self.to_sheet(nth, point(p)));
        let vertices = points.map(Vertex::line).collect();
        let contour = Contour { vertices };
        (id, Line { layer: String::new(), closed: true, contour }.middle())
    }

    pub(crate) fn placement(&self, nth: usize) -> &Value {
        &self.manifest["sheets"][0]["placements"][nth]
    }

    pub(crate) fn part(&self, id: &str) -> &Value {
        let parts = self.manifest["parts"].as_array().unwrap();
        parts.iter().find(|part| part["id"] == id).unwrap()
    }

    pub(crate) fn to_sheet(&self, nth: usize, p: Point2) -> Point2 {
        let placement = self.placement(nth);
        let number = |key: &str| placement[key].as_f64().unwrap();
        let turn = nalgebra::Rotation2::new(number("angle_deg").to_radians());
        turn * p + Vector2::new(number("x"), number("y"))
    }

    /// A slit of a placed part: its node, and on the sheet the middle of its mouth, the
    /// direction into it and across it.
    pub(crate) fn slit(
        &self,
        nth: usize,
        slit: usize,
    ) -> (u64, Point2, Vector2, Vector2) {
        let (id, _) = self.placed(nth);
        let strip = &self.part(&id)["strip"];
        let slit = &strip["slits"][slit];
        let axes = strip["axes"].as_array().unwrap();
        let axis = axes.iter().find(|axis| axis["node"] == slit["node"]).unwrap();
        let bottom = self.to_sheet(nth, point(&axis["bottom"]));
        let top = self.to_sheet(nth, point(&axis["top"]));
        let from_top = slit["from"] == "top";
        let (mouth, end) = if from_top { (top, bottom) } else { (bottom, top) };
        let inward = (end - mouth).normalize();
        let up = (top - bottom).normalize();
        let across = Vector2::new(up.y, -up.x);
        let middle = mouth + across * slit["offset"].as_f64().unwrap();
        (slit["node"].as_u64().unwrap(), middle, inward, across)
    }

    /// Moves the corners of a slit across it, each by what `by` says of its side.
    pub(crate) fn bend_slit(
        &mut self,
        nth: usize,
        slit: usize,
        by: impl Fn(f64) -> f64,
    ) -> (String, u64) {
        let (node, middle, inward, across) = self.slit(nth, slit);
        let (id, line) = self.outline(nth);
        line.contour = line.contour.moved(|p| {
            let (side, deep) = ((p - middle).dot(&across), (p - middle).dot(&inward));
            let inside = side.abs() < 5.0 && (-0.5..20.0).contains(&deep);
            if inside { p + across * by(side) } else { p }
        });
        (id, node)
    }

    /// Proves the job with its first sheet and manifest as they are now.
    pub(crate) fn proof(mut self) -> Proof {
        self.files.insert(DXF.into(), written(&self.lines, 4));
        self.files.insert("job.json".into(), self.manifest.to_string().into_bytes());
        prove(&self.files).unwrap()
    }
}

pub(crate) fn point(value: &Value) -> Point2 {
    Point2::new(value[0].as_f64().unwrap(), value[1].as_f64().unwrap())
}

pub(crate) fn read_lines(bytes: &[u8]) -> Vec<Line> {
    let drawing = dxf::Drawing::load(&mut &*bytes).unwrap();
    let lines = drawing.entities().map(|entity| {
        let dxf::entities::EntityType::Polyline(line) = &entity.specific else {
            panic!()
        };
        let corner = |v: &dxf::entities::Vertex| {
            Vertex::arc(Point2::new(v.location.x, v.location.y), v.bulge)
        };
        let contour = Contour { vertices: line.vertices().map(corner).collect() };
        Line { layer: entity.common.layer.clone(), closed: line.is_closed(), contour }
    });
    lines.collect()
}

/// The lines as a CAD program would save them: R2000 with LWPOLYLINE.
pub(crate) fn written(lines: &[Line], unit: i32) -> Vec<u8> {
    let mut text = format!(
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n{unit}\n0\nENDSEC\n\
         0\nSECTION\n2\nENTITIES\n"
    );
    for line in lines {
        let (layer, count) = (&line.layer, line.contour.vertices.len());
        text += &format!(
            "0\nLWPOLYLINE\n8\n{layer}\n90\n{count}\n70\n{}\n",
            u8::from(line.closed)
        );
        for v in &line.contour.vertices {
            text += &format!("10\n{}\n20\n{}\n42\n{}\n", v.point.x, v.point.y, v.bulge);
        }
    }
    (text + "0\nENDSEC\n0\nEOF\n").into_bytes()
}

/// The finding with this code about this part.
pub(crate) fn found<'a>(proof: &'a Proof, code: &str, part: &str) -> &'a Finding {
    let of_part =
        |f: &&Finding| f.code == code && f.place.parts.iter().any(|id| id == part);
    assert!(!passes(&proof.findings), "{code} passes");
    proof.findings.iter().find(of_part).unwrap_or_else(|| {
        panic!("no {code} of {part} in {:#?}", proof.findings);
    })
}

pub(crate) fn is_near(finding: &Finding, at: Point2, reach: f64) {
    let found = finding.place.at.map(Point2::from).unwrap();
    assert!((found - at).norm() < reach, "{found} is not near {at}: {}", finding.message);
}
