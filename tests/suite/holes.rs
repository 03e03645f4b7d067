//! Parts in the holes of parts: the holes are used at every effort, and what lies there
//! keeps its distance.

use finwright::geometry::{Point2, trig};
use finwright::nest::{Effort, Layout, Rotations, Shape, Stock, check, search, strip};
use std::f64::consts::{FRAC_PI_2, TAU};

fn square(name: &str, side: f64) -> Shape {
    let corners = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
    Shape {
        name: name.into(),
        outline: corners.map(Point2::from).to_vec(),
        holes: Vec::new(),
        rotations: Rotations::Free,
        priority: 0,
    }
}

/// A square frame with a web of 20 mm.
fn frame(name: &str, side: f64) -> Shape {
    let (low, high) = (20.0, side - 20.0);
    let hole = [[low, low], [low, high], [high, high], [high, low]];
    Shape { holes: vec![hole.map(Point2::from).to_vec()], ..square(name, side) }
}

fn circle(radius: f64, corners: usize) -> Vec<Point2> {
    let at = |k: usize| TAU * k as f64 / corners as f64;
    let corner =
        |turn: f64| Point2::new(radius * trig::cos(turn), radius * trig::sin(turn));
    (0..corners).map(|k| corner(at(k))).collect()
}

fn disc(name: &str, radius: f64) -> Shape {
    Shape { outline: circle(radius, 40), ..square(name, 1.0) }
}

fn ring(name: &str, [outer, inner]: [f64; 2]) -> Shape {
    let mut hole = circle(inner, 40);
    hole.reverse();
    Shape { holes: vec![hole], ..disc(name, outer) }
}

fn laid(shapes: &[Shape], stock: &[Stock], trials: u32) -> Layout {
    let effort = Effort { trials, seed: 0 };
    let found = search(shapes, stock, &effort, &mut ()).expect("a layout");
    assert_eq!(found.unplaced, []);
    assert_eq!(check(&found.layout, shapes, stock), []);
    found.layout
}

/// How many parts lie inside the outlines of others.
fn in_holes(layout: &Layout, shapes: &[Shape]) -> usize {
    let all = layout.sheets.iter().map(|sheet| {
        let placed = sheet.placements.iter().map(|p| {
            let motion = p.motion();
            let outline = shapes[p.shape].outline.iter();
            outline.map(|&q| motion.apply(q)).collect::<Vec<_>>()
        });
        let placed: Vec<Vec<Point2>> = placed.collect();
        let is_inside = |part: &&Vec<Point2>| {
            let others = placed.iter().filter(|other| other != part);
            let contains = finwright::geometry::predicates::contains;
            others.into_iter().any(|other| contains(other, part[0]))
        };
        placed.iter().filter(is_inside).count()
    });
    all.sum()
}

#[test]
fn the_empty_hole_of_a_frame_takes_the_lid_at_every_effort() {
    let stock = [Stock { count: Some(1), ..Stock::new([320.0, 320.0], 5.0, 2.0) }];
    let shapes = [frame("frame", 300.0), square("lid", 100.0)];
    for trials in [1, 3, 30] {
        let layout = laid(&shapes, &stock, trials);
        assert_eq!(in_holes(&layout, &shapes), 1, "{trials}");
    }
}

#[test]
fn twelve_squares_lie_in_five_frames() {
    let stock = [Stock::new([320.0, 320.0], 5.0, 2.0)];
    let mut shapes = vec![frame("frame", 300.0); 5];
    shapes.extend(vec![square("square", 100.0); 12]);
    for trials in [1, 10] {
        let layout = laid(&shapes, &stock, trials);
        assert_eq!(layout.sheets.len(), 5, "{trials}");
    }
    // Holes that are taken away are not filled: `--no-parts-in-holes`.
    shapes.iter_mut().for_each(|shape| shape.holes.clear());
    for trials in [1, 10] {
        let layout = laid(&shapes, &stock, trials);
        assert_eq!((layout.sheets.len(), in_holes(&layout, &shapes)), (7, 0));
    }
}

#[test]
fn rings_lie_in_rings_and_discs_in_them() {
    let stock = [Stock { count: Some(1), ..Stock::new([250.0, 250.0], 5.0, 2.0) }];
    let shapes =
        [disc("disc", 40.0), ring("small", [70.0, 45.0]), ring("large", [115.0, 78.0])];
    for trials in [1, 20] {
        assert_eq!(in_holes(&laid(&shapes, &stock, trials), &shapes), 2, "{trials}");
    }
}

#[test]
fn what_lies_in_a_hole_keeps_to_its_own_rotations() {
    let stock = [Stock { count: Some(1), ..Stock::new([210.0, 410.0], 5.0, 2.0) }];
    let mut shapes = [frame("frame", 200.0), square("bar", 150.0)];
    shapes[0].outline.iter_mut().for_each(|p| p.y *= 2.0);
    shapes[0].holes[0].iter_mut().for_each(|p| p.y *= 2.0);
    shapes[1].outline.iter_mut().for_each(|p| p.y *= 2.0);
    for allowed in [0.0, FRAC_PI_2] {
        shapes[1].rotations = Rotations::Only(vec![allowed]);
        let corner = Stock::new([410.0, 210.0], 5.0, 2.0);
        let upright = allowed == 0.0;
        let stock =
            if upright { stock.clone() } else { [Stock { count: Some(1), ..corner }] };
        for trials in [1, 10] {
            let layout = laid(&shapes, &stock, trials);
            let all = layout.sheets.iter().flat_map(|sheet| &sheet.placements);
            let bar = all.into_iter().find(|p| p.shape == 1).expect("it is laid");
            assert!((bar.angle - allowed).abs() < 1e-9, "{bar:?}");
        }
    }
}

/// A large frame for which there is no sheet left does not take the small parts with it.
#[test]
fn what_would_lie_in_a_part_without_a_place_is_laid_beside() {
    let stock = [Stock { count: Some(1), ..Stock::new([320.0, 320.0], 5.0, 2.0) }];
    let mut shapes = vec![square("board", 250.0), frame("frame", 300.0)];
    shapes.extend(vec![square("square", 40.0); 4]);
    shapes[0].priority = 1;
    for trials in [1, 10] {
        let effort = Effort { trials, seed: 0 };
        let found = search(&shapes, &stock, &effort, &mut ()).expect("a layout");
        assert_eq!(check(&found.layout, &shapes, &stock), []);
        assert_eq!(found.layout.sheets[0].placements.len(), 5, "{trials}");
    }
}

/// A part that is nearly as wide as its sheet stays inside the margin while the sheet is
/// pressed together: the search's layout is sound and not thrown away.
#[test]
fn a_search_with_a_part_as_wide_as_the_sheet_keeps_what_it_finds() {
    let stock = [Stock::new([320.0, 320.0], 5.0, 2.0)];
    let shapes = [frame("frame", 309.0), square("lid", 100.0)];
    let layout = laid(&shapes, &stock, 30);
    assert_eq!((layout.sheets.len(), in_holes(&layout, &shapes)), (1, 1));
}

#[test]
fn a_strip_uses_holes_too() {
    let shapes = [frame("frame", 300.0), square("lid", 100.0), square("lid", 100.0)];
    let sheet = Stock::new([1.0, 320.0], 5.0, 2.0);
    let effort = Effort { trials: 10, seed: 0 };
    let found = strip(&shapes, &sheet, &effort, &mut ()).expect("a strip");
    assert_eq!(in_holes(&found.layout, &shapes), 2);
    assert!(found.length < 311.0, "{}", found.length);
}

/// A part as large, as wide or as high as the sheet inside its margin fits, turned or not.
#[test]
fn a_part_exactly_as_large_as_the_free_area_fits() {
    let board = |size: [f64; 2]| {
        let mut board = square("board", 1.0);
        board
            .outline
            .iter_mut()
            .for_each(|p| (p.x, p.y) = (p.x * size[0], p.y * size[1]));
        board
    };
    let stock = [Stock::new([600.0, 400.0], 5.0, 2.0)];
    for (size, count) in [
        ([590.0, 390.0], 1),
        ([390.0, 590.0], 1),
        ([590.0, 30.0], 12),
        ([30.0, 390.0], 17),
        ([589.7, 389.3], 1),
    ] {
        let shapes = vec![board(size); count];
        for trials in [1, 3] {
            assert_eq!(laid(&shapes, &stock, trials).sheets.len(), 1, "{size:?}");
        }
    }
    let fraction = [Stock::new([600.4, 400.4], 5.0, 2.0)];
    assert_eq!(laid(&[board([590.4, 390.4])], &fraction, 3).sheets.len(), 1);
    let mut turned = board([590.0, 390.0]);
    let motion = finwright::geometry::Motion::rotation(0.7);
    turned.outline.iter_mut().for_each(|p| *p = motion.apply(*p));
    assert_eq!(laid(&[turned], &stock, 3).sheets.len(), 1);
    let beyond = [board([590.001, 390.0])];
    let found = search(&beyond, &stock, &Effort { trials: 1, seed: 0 }, &mut ());
    assert_eq!(found.expect("a layout").unplaced.len(), 1);
    let effort = Effort { trials: 3, seed: 0 };
    let mut high = board([100.0, 390.0]);
    high.rotations = Rotations::Only(vec![0.0]);
    let high = strip(&[high], &stock[0], &effort, &mut ());
    assert!(high.expect("a strip").length < 110.001);
}
