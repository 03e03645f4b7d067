//! Axes on the dense surface: what the structure's axes should be.

use crate::design::surface::{Measures, Surface, previous};
use crate::geometry::{Vector3, trig};
use crate::sparse::{Cholesky, NotPositiveDefinite, Triplets};

/// The wanted axes of a surface: those of its file, or its normals, smoothed over `length`.
///
/// Smoothing is one step of heat flow, (M + t L) e = M n with t = `length`² / 2 (implicit
/// Euler; Desbrun and others 1999, Implicit fairing of irregular meshes), so that it reaches
/// as far on fine triangles as on coarse ones.
///
/// # Errors
/// [`NotPositiveDefinite`] if the system cannot be factored.
pub(super) fn wanted(
    surface: &Surface,
    measures: &Measures,
    length: f64,
) -> Result<Vec<Vector3>, NotPositiveDefinite> {
    if let Some(axes) = &surface.axes {
        return Ok(axes.clone());
    }
    let count = surface.positions.len();
    let mut normals = vec![Vector3::zeros(); count];
    let mut masses = vec![0.0; count];
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        for &vertex in corners {
            normals[vertex] += measures.frames[triangle][2] * measures.areas[triangle];
            masses[vertex] += measures.areas[triangle] / 3.0;
        }
    }
    let time = length * length / 2.0;
    let mut system = Triplets::new(count);
    for (vertex, &mass) in masses.iter().enumerate() {
        system.add([vertex, vertex], mass);
    }
    for side in 0..surface.side_count() {
        let angle = measures.angles[previous(side)];
        let ends = [surface.tail(side), surface.tip(side)];
        // Negative weights of obtuse corners could turn axes against one another.
        let weight = (1.0 / trig::tan(angle)).max(0.0) / 2.0;
        system.add_difference(ends, [1.0, 1.0], time * weight);
    }
    let mut factor = Cholesky::of(&system.matrix())?;
    let mut right = vec![0.0; 3 * count];
    for (vertex, normal) in normals.iter().enumerate() {
        let normal = normal.try_normalize(0.0).unwrap_or(Vector3::z());
        (0..3).for_each(|k| right[k * count + vertex] = masses[vertex] * normal[k]);
    }
    factor.solve(&mut right);
    let axis = |vertex: usize| {
        let axis = Vector3::from_fn(|k, _| right[k * count + vertex]);
        axis.try_normalize(0.0).unwrap_or(Vector3::z())
    };
    Ok((0..count).map(axis).collect())
}
