//! Structures made here and not in the crate, each torsion-free by construction, and jobs
//! made of them.

use finwright::fabrication::{Fabrication, fabricate};
use finwright::geometry::{Point3, Vector3};
use finwright::nest::Effort;
use finwright::settings::Settings;
use finwright::structure::Draft;
use finwright::template::{self, Template};
use proptest::prelude::{Just, Strategy, prop_oneof};

/// A template by name.
pub(crate) fn material(name: &str) -> Template {
    let source = template::embedded(name).expect("the template is embedded");
    template::read(source, name).expect("embedded templates are sound")
}

/// The job of a draft; its structure must be one.
pub(crate) fn made(draft: Draft, template: &Template) -> Fabrication {
    let effort = Effort { trials: 1, seed: 0 };
    let settings = Settings { effort, ..Settings::new(template.clone()) };
    let job = fabricate(draft, settings, &mut ()).expect("nobody stops it");
    assert!(job.structure.is_some(), "{:?}", job.findings);
    job
}

/// Faces of a grid of `columns` × `rows` nodes, row by row.
pub(crate) fn grid(columns: usize, rows: usize) -> Vec<Vec<usize>> {
    let mut faces = Vec::new();
    for j in 0..rows - 1 {
        for i in 0..columns - 1 {
            let k = j * columns + i;
            faces.push(vec![k, k + 1, k + columns + 1, k + columns]);
        }
    }
    faces
}

/// Where the axes of a grid come from.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Axes {
    /// All in one direction: any mesh has planar fins.
    Parallel(f64, f64),
    /// All through a point so far below: any mesh has planar fins.
    Radial(f64),
    /// A net parallel to a translational surface (Combescure): fins are trapezoids.
    Net(f64),
}

fn axes() -> impl Strategy<Value = Axes> {
    prop_oneof![
        (-0.2..0.2, -0.2..0.2).prop_map(|(x, y)| Axes::Parallel(x, y)),
        (400.0..2000.0).prop_map(Axes::Radial),
        (-0.01..0.01).prop_map(Axes::Net),
    ]
}

/// Steps of a curve: forward and up, mm.
fn steps() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let step = (24.0..45.0, -5.0..5.0).prop_map(|(along, up)| [along, up]);
    proptest::collection::vec(step, 2..7)
}

/// Translational grids of 3 to 7 nodes each way.
pub(crate) fn translational() -> impl Strategy<Value = Draft> {
    (steps(), steps(), axes()).prop_map(|(across, along, axes)| {
        let curve = |steps: &[[f64; 2]], way: Vector3| {
            let mut points = vec![Vector3::zeros()];
            for &[forward, up] in steps {
                let last = points[points.len() - 1];
                points.push(last + way * forward + Vector3::z() * up);
            }
            points
        };
        let across = curve(&across, Vector3::x());
        let along = curve(&along, Vector3::y());
        let sums = || along.iter().flat_map(|q| across.iter().map(move |p| p + q));
        let axis = |p: Vector3| match axes {
            Axes::Parallel(x, y) => Vector3::new(x, y, 1.0),
            Axes::Radial(depth) => p + Vector3::z() * depth,
            Axes::Net(pace) => Vector3::z() * 10.0 + p * pace,
        };
        Draft {
            name: "grid".into(),
            positions: sums().map(Point3::from).collect(),
            axes: sums().map(axis).collect(),
            faces: grid(across.len(), along.len()),
            ..Draft::default()
        }
        .with_depth(14.0, 16.0)
    })
}

/// Patches around a node with three or five fins, nodes jittered, axes through a point.
pub(crate) fn star() -> impl Strategy<Value = Draft> {
    let jitter = proptest::collection::vec([-2.0..2.0, -2.0..2.0, -2.0..2.0], 16);
    (prop_oneof![Just(3_usize), Just(5)], jitter, 500.0..1500.0).prop_map(
        |(sectors, jitter, radius)| {
            let turn = |k: f64| {
                let angle = std::f64::consts::TAU * k / sectors as f64;
                let [sin, cos] = [
                    finwright::geometry::trig::sin(angle),
                    finwright::geometry::trig::cos(angle),
                ];
                Vector3::new(cos, sin, 0.0)
            };
            // The centre, then for each sector: two nodes on its ray, three between rays.
            let mut flat = vec![Vector3::zeros()];
            let mut faces = Vec::new();
            for k in 0..sectors {
                let (own, middle) = (turn(k as f64), turn(k as f64 + 0.5));
                let next = turn(k as f64 + 1.0);
                flat.extend([own * 45.0, own * 85.0, middle * 60.0]);
                flat.extend([own * 85.0 + next * 40.0, next * 85.0 + own * 40.0]);
                let at = |node: usize| 1 + 5 * k + node;
                let beside = |node: usize| 1 + 5 * ((k + 1) % sectors) + node;
                faces.push(vec![0, at(0), at(2), beside(0)]);
                faces.push(vec![at(0), at(1), at(3), at(2)]);
                faces.push(vec![beside(0), at(2), at(4), beside(1)]);
            }
            let shaken = |(k, p): (usize, &Vector3)| {
                let fall = Vector3::z() * (radius - p.norm_squared() / (2.0 * radius));
                p + fall + Vector3::from(jitter[k % jitter.len()])
            };
            let out: Vec<Vector3> = flat.iter().enumerate().map(shaken).collect();
            Draft {
                name: "star".into(),
                positions: out.iter().map(|p| Point3::from(*p)).collect(),
                axes: out,
                faces,
                ..Draft::default()
            }
            .with_depth(15.0, 15.0)
        },
    )
}

/// Any of them.
pub(crate) fn any() -> impl Strategy<Value = Draft> {
    prop_oneof![3 => translational().boxed(), 1 => star().boxed()]
}

/// A flat mesh of equal triangles with upright axes: six fins in a node, all three pairs
/// equally straight.
pub(crate) fn triangles(columns: usize, rows: usize) -> Draft {
    let slant = 0.75_f64.sqrt();
    let nodes = (0..rows).flat_map(|j| (0..columns).map(move |i| (i as f64, j as f64)));
    let positions =
        nodes.map(|(i, j)| Point3::new(60.0 * (i + j / 2.0), 60.0 * slant * j, 0.0));
    let halves = grid(columns, rows).into_iter().flat_map(|quad| {
        let [a, b, c, d] = quad[..] else { return Vec::new() };
        vec![vec![a, b, d], vec![b, c, d]]
    });
    Draft {
        name: "triangles".into(),
        positions: positions.collect(),
        axes: vec![Vector3::z(); columns * rows],
        faces: halves.collect(),
        ..Draft::default()
    }
    .with_depth(15.0, 15.0)
}
