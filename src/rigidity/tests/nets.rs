//! Nets of nodes with axes, as hinged fins or rigid strips.

use crate::geometry::{Point3, Vector3, trig};
use crate::ids::{FinId, StripId};
use crate::rigidity::{Coupling, Model, RigidBody};

/// A patch of a torus (radii 3 and 1, its outer side) with its normals, as hinged fins or
/// rigid strips.
pub(super) fn torus(n: usize, strips: bool) -> Model {
    let place = |i: usize, j: usize| {
        let (u, v) = (0.2 * i as f64, 0.1 * j as f64 - 0.05 * n as f64);
        let out = Vector3::new(
            trig::cos(v) * trig::cos(u / 2.0),
            trig::cos(v) * trig::sin(u / 2.0),
            trig::sin(v),
        );
        let ring = Vector3::new(trig::cos(u / 2.0), trig::sin(u / 2.0), 0.0) * 3.0;
        (Point3::from(ring + out), out)
    };
    grid(n, strips, place)
}

/// A net of `n` × `n` nodes.
pub(super) fn grid(
    n: usize,
    strips: bool,
    place: impl Fn(usize, usize) -> (Point3, Vector3),
) -> Model {
    grid_by([n, n], strips, place)
}

/// A net of `n` × `m` nodes.
fn grid_by(
    [n, m]: [usize; 2],
    strips: bool,
    place: impl Fn(usize, usize) -> (Point3, Vector3),
) -> Model {
    let mut on = vec![Vec::new(); n * m];
    let mut bodies = Vec::new();
    for j in 0..m {
        for i in 0..n {
            if strips {
                on[j * n + i].extend([j, m + i]);
                continue;
            }
            for other in [(i + 1 < n).then_some(1), (j + 1 < m).then_some(n)] {
                let Some(step) = other else { continue };
                let at = j * n + i;
                on[at].push(bodies.len());
                on[at + step].push(bodies.len());
                bodies
                    .push(RigidBody::Fin(FinId::between(at.into(), (at + step).into())));
            }
        }
    }
    if strips {
        bodies = (0..n + m).map(StripId::new).map(RigidBody::Strip).collect();
    }
    let couplings = on.into_iter().enumerate().map(|(node, mut bodies)| {
        let (p, a) = place(node % n, node / n);
        let half = a.normalize() * 0.1;
        bodies.sort_unstable();
        let points = vec![p - half, p + half];
        Coupling { node: node.into(), points, bodies, held: false, share: 0.5 }
    });
    Model::new(bodies, couplings.collect())
}

/// A scatter that is the same everywhere, from -1 to 1.
pub(super) fn noise(k: usize) -> f64 {
    2.0 * ((k as f64 + 1.0) * 0.618_033_988_749_894_9).fract() - 1.0
}

/// A plane net, its inner lines bent by `jitter`.
pub(super) fn plan(i: usize, j: usize, jitter: f64) -> [f64; 2] {
    let k = 31 * i + 17 * j;
    [i as f64 + jitter * noise(k), j as f64 + jitter * noise(k + 7)]
}

pub(super) fn parallel(n: usize, strips: bool, jitter: f64) -> Model {
    parallel_by([n, n], strips, jitter)
}

pub(super) fn parallel_by(size: [usize; 2], strips: bool, jitter: f64) -> Model {
    grid_by(size, strips, |i, j| {
        let [x, y] = plan(i, j, jitter);
        (Point3::new(x, y, 0.05 * x * y), Vector3::z())
    })
}

/// Axes through one point, nodes on a sphere around it, over a plane net: a gnomonic grid.
pub(super) fn radial(n: usize, strips: bool, jitter: f64) -> Model {
    radial_by([n, n], strips, jitter)
}

pub(super) fn radial_by([n, m]: [usize; 2], strips: bool, jitter: f64) -> Model {
    let [x0, y0] = [n, m].map(|count| (count as f64 - 1.0) / 2.0);
    let radius = n.max(m) as f64;
    grid_by([n, m], strips, |i, j| {
        let [x, y] = plan(i, j, jitter);
        let out = Vector3::new(x - x0, y - y0, radius).normalize();
        (Point3::from(out * radius), out)
    })
}

/// A patch of an ellipsoid with its normals along lines of curvature: a spheroid of half
/// axes 3 and 2, its meridians and parallels.
pub(super) fn ellipsoid(n: usize, strips: bool) -> Model {
    grid(n, strips, |i, j| {
        let (u, v) = (0.15 * i as f64, 0.3 + 0.1 * j as f64);
        let ring = Vector3::new(trig::cos(u), trig::sin(u), 0.0) * trig::cos(v);
        let place = ring * 3.0 + Vector3::z() * (2.0 * trig::sin(v));
        let normal = ring / 3.0 + Vector3::z() * (trig::sin(v) / 2.0);
        (Point3::from(place), normal)
    })
}

/// A translational net whose axes are a net parallel to it.
pub(super) fn combescure(n: usize, strips: bool) -> Model {
    let step = |k: usize, way: Vector3| way + Vector3::z() * (0.3 - 0.12 * k as f64);
    let along = |k: usize, way: Vector3, lean: f64| {
        let steps = (0..k).map(|m| (step(m, way), lean * (0.1 + 0.03 * noise(m))));
        steps.fold((Vector3::zeros(), Vector3::zeros()), |(p, a), (s, l)| {
            (p + s, a - s * l)
        })
    };
    grid(n, strips, |i, j| {
        let (p, a) = along(i, Vector3::x(), 1.0);
        let (q, b) = along(j, Vector3::y(), 0.7);
        (Point3::from(p + q), Vector3::z() + a + b)
    })
}

pub(super) fn held_all_round(mut model: Model, n: usize) -> Model {
    for coupling in &mut model.couplings {
        let (i, j) = (coupling.node.index() % n, coupling.node.index() / n);
        coupling.held = i == 0 || j == 0 || i + 1 == n || j + 1 == n;
    }
    model
}
