//! The numbers of the line and of the scanline walk at one pixel, found by walking once more.

use glam::DVec2;

use super::history::{Field, USED, Value, field, table, value_names};
use super::record::{FilledTriangle, Pixel, Primitive};
use crate::Rect;
use crate::edge::{SUBPIXELS, center};
use crate::interpolate::{Interpolation, Projected, linear};
use crate::line::StepAxis;
use crate::scanline::{Corner, Edge, Half, Payload, Span, StepLimit, Walk, split};

/// The step of a line that drew a pixel.
pub(super) fn line_at(a: DVec2, b: DVec2, axis: StepAxis, pixel: Pixel, window: Rect) -> Vec<Field> {
    let mut fields = vec![field(
        "ends",
        "on the screen",
        table(
            &["x", "y"],
            [("a", a), ("b", b)].map(|(name, p)| (name.to_owned(), p.to_array().map(Some).to_vec())).to_vec(),
        ),
    )];
    let slope = (b.y - a.y) / (b.x - a.x);
    fields.push(field("slope", "k = Δy/Δx", Value::Number(slope)));
    let is_flat = slope.abs() < 1.0 || axis == StepAxis::X;
    let (low, along, across) = if is_flat {
        (if a.x < b.x { a } else { b }, 'x', 'y')
    } else {
        let low = if a.y < b.y { a } else { b };
        (DVec2::new(low.y, low.x), 'y', 'x')
    };
    // The same additions as the line's own.
    let step = if is_flat { slope } else { 1.0 / slope };
    let target = f64::from(if is_flat { pixel.0 } else { pixel.1 });
    let skipped = f64::from(if is_flat { window.left } else { window.bottom }) - low.x.trunc();
    let (mut running, mut other, mut count) = (low.x, low.y, 0);
    if skipped > 0.0 {
        (running, other, count) =
            (running.fract() + running.trunc() + skipped, other + step * skipped, skipped as i64);
    }
    while running.trunc() < target {
        (running, other, count) = (running + 1.0, other + step, count + 1);
    }
    fields.push(field("step", "step", Value::Whole(count)));
    fields.push(field("along", "", Value::Number(running)));
    fields.push(field("across", "", Value::Number(other)));
    let text = format!("{along} = {running:.4}, {across} = {other:.4}, cut to ({}, {})", pixel.0, pixel.1);
    fields.push(field("", "running", Value::Text(text)));
    fields
}

/// Which row of which half met a pixel, with the parameters on the way.
#[derive(Clone, Copy)]
struct Hit {
    half: usize,
    ends: [f64; 2],
    /// t on the left and on the right edge.
    edges: [f64; 2],
    /// t′ along the row.
    along: f64,
}

/// Walks a half with the parameter t as its payload, and keeps what meets the pixel.
fn walk_t<A: Copy>(
    half: &Half<A>,
    index: usize,
    walk: Walk,
    (x, y): Pixel,
    window: Rect,
    hits: &mut Vec<Hit>,
) {
    half.walk(
        |_| [0.0, 1.0],
        walk,
        window,
        |span: Span<f64>| {
            if span.y == y && span.columns().contains(&x) {
                let mut hit = Hit { half: index, ends: span.ends, edges: span.payload, along: 0.0 };
                span.step(0.0, 1.0, |column, t| {
                    if column == x {
                        hit.along = t;
                    }
                });
                hits.push(hit);
            }
        },
    );
}

/// For each time that a triangle, or half of one, met the pixel: the fields.
pub(super) fn rows_at(primitive: &Primitive, pixel: Pixel, window: Rect) -> Vec<Vec<Field>> {
    match primitive {
        Primitive::Half { left, right, walk } => {
            let corner = |position| Corner { position, attributes: () };
            let edge = |[start, end]: [DVec2; 2]| Edge { start: corner(start), end: corner(end) };
            let half = Half { left: edge(*left), right: edge(*right) };
            let mut hits = Vec::new();
            walk_t(&half, 0, *walk, pixel, window, &mut hits);
            let rows = [
                ("left, from", left[0]),
                ("left, to", left[1]),
                ("right, from", right[0]),
                ("right, to", right[1]),
            ];
            let rows = rows.map(|(name, p)| (name.to_owned(), p.to_array().map(Some).to_vec())).to_vec();
            let edges = field("sides", "on the screen", table(&["x", "y"], rows));
            hits.iter().map(|hit| vec![edges.clone(), row_text("", hit, pixel)]).collect()
        }
        Primitive::Triangle(triangle) => triangle_hits(triangle, pixel, window),
        Primitive::Line { .. } | Primitive::Coverage(_) => Vec::new(),
    }
}

fn row_text(half: &str, hit: &Hit, (x, y): Pixel) -> Field {
    let [start, end] = hit.ends;
    let text = format!("{half}y = {y}, from x = {start:.4} to {end:.4}; here x = {x}");
    field("row", "row", Value::Text(text))
}

/// One value of a triangle's corners, as the walk carries it.
fn component(
    triangle: &FilledTriangle,
    k: usize,
    interpolation: Interpolation,
) -> Option<[Half<Projected<f64, 1>>; 2]> {
    let w = triangle.w.unwrap_or([1.0; 3]);
    let corners = [0, 1, 2].map(|i| Corner {
        position: triangle.corners[i],
        attributes: Projected { w: w[i], values: [triangle.values[i].get(k).copied().unwrap_or_default()] },
    });
    split(corners, |a, b, t| interpolation.between(a, b, t))
}

/// ω and a value at the left end of the row, at its right end, and at the pixel.
fn interpolated(
    triangle: &FilledTriangle,
    k: usize,
    interpolation: Interpolation,
    hit: &Hit,
) -> [Projected<f64, 1>; 3] {
    let Some(halves) = component(triangle, k, interpolation) else {
        return [Projected { w: 0.0, values: [0.0] }; 3];
    };
    let half = &halves[hit.half];
    let at = |edge: &Edge<Projected<f64, 1>>, t| {
        interpolation.between(edge.start.attributes, edge.end.attributes, t)
    };
    let (left, right) = (at(&half.left, hit.edges[0]), at(&half.right, hit.edges[1]));
    [left, right, interpolation.between(left, right, hit.along)]
}

/// Something that is stepped by itself, a depth or a value of chapter 3: at both ends of the row, and at the pixel.
fn stepped<P: Payload>(
    triangle: &FilledTriangle,
    corners: [P; 3],
    limit: StepLimit,
    hit: usize,
    (x, y): Pixel,
    window: Rect,
    between: impl Fn(P, P, f64) -> P,
) -> Option<[P; 3]> {
    let corners = [0, 1, 2].map(|i| Corner { position: triangle.corners[i], attributes: corners[i] });
    let walk = Walk { limit, ..triangle.walk };
    let mut found = Vec::new();
    for half in split(corners, between).into_iter().flatten() {
        half.walk(
            |edge| [edge.start.attributes, edge.end.attributes],
            walk,
            window,
            |span| {
                if span.y == y {
                    let [start, end] = span.payload;
                    span.step(start, end, |column, value| {
                        if column == x {
                            found.push([start, end, value]);
                        }
                    });
                }
            },
        );
    }
    found.get(hit).copied()
}

fn triangle_hits(triangle: &FilledTriangle, pixel: Pixel, window: Rect) -> Vec<Vec<Field>> {
    let corners = triangle.corners.map(|position| Corner { position, attributes: () });
    let mut hits = Vec::new();
    for (i, half) in split(corners, |(), (), _| ()).iter().flatten().enumerate() {
        walk_t(half, i, triangle.walk, pixel, window, &mut hits);
    }
    let fields = |(i, hit): (usize, &Hit)| {
        let mut fields = screen_fields(triangle, hit, pixel);
        if triangle.w.is_some() {
            fields.extend(parameters(triangle, hit));
            fields.extend(end_of_row(hit));
            fields.push(projected_values(triangle, hit));
            let limit = if triangle.walk.limit == StepLimit::Everywhere {
                StepLimit::Everywhere
            } else {
                StepLimit::Overrun
            };
            let between = |a: f64, b: f64, t| a.stepped(f64::slope(a, b, 1.0), t);
            if let Some([left, right, here]) =
                triangle.depth.and_then(|depth| stepped(triangle, depth, limit, i, pixel, window, between))
            {
                let rows = [("left", left), ("right", right), ("here", here)];
                let rows = rows.map(|(name, depth)| (name.to_owned(), vec![Some(depth)])).to_vec();
                fields.push(field("depths", "depth, stepped", table(&["z"], rows)));
            }
        } else {
            fields.push(stepped_values(triangle, i, pixel, window));
        }
        fields
    };
    hits.iter().enumerate().map(fields).collect()
}

/// The corners on the screen, P′ among them, and the row.
fn screen_fields(triangle: &FilledTriangle, hit: &Hit, pixel: Pixel) -> Vec<Field> {
    let half = component(triangle, 0, Interpolation::Affine).map(|halves| halves[hit.half]);
    let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    for (i, name) in ["A", "B", "C"].into_iter().enumerate() {
        let [x, y] = triangle.corners[i].to_array();
        let numbers = [Some(x), Some(y), triangle.w.map(|w| w[i]), triangle.depth.map(|depth| depth[i])];
        rows.push((name.to_owned(), numbers.to_vec()));
    }
    let mut text = String::new();
    if let Some(half) = half {
        for (name, edge) in [("left", half.left), ("right", half.right)] {
            text += &format!(
                "{name} {}{}, ",
                corner_name(triangle, edge.start.position),
                corner_name(triangle, edge.end.position)
            );
        }
    }
    let columns: &[&str] = match (triangle.w, triangle.depth) {
        (None, _) => &["x", "y"],
        (_, None) => &["x", "y", "ω"],
        _ => &["x", "y", "ω", "z"],
    };
    for row in &mut rows {
        row.1.truncate(columns.len());
    }
    let which = ["lower half, ", "upper half, "][hit.half];
    vec![
        field("screen", "on the screen", table(columns, rows)),
        field("half", "", Value::Text(["lower", "upper"][hit.half].to_owned())),
        field("sides", "sides", Value::Text(text.trim_end_matches(", ").to_owned())),
        row_text(which, hit, pixel),
    ]
}

/// A, B, C, or the new corner P′ on the long edge.
fn corner_name(triangle: &FilledTriangle, position: DVec2) -> &'static str {
    let known = triangle.corners.iter().position(|corner| *corner == position);
    known.map_or("P′", |i| ["A", "B", "C"][i])
}

/// t on both edges and t′ along the row, and what is made of them.
fn parameters(triangle: &FilledTriangle, hit: &Hit) -> [Field; 3] {
    let (name, formula) = match triangle.interpolation {
        Interpolation::Affine => ("affine", "V = Va + (Vb − Va) t′"),
        Interpolation::PerspectiveCorrect => {
            ("perspective-correct", "V_p = (ωb Va + (ωa Vb − ωb Va) t′) / (ωb + (ωa − ωb) t′)")
        }
        Interpolation::Reciprocal => ("reciprocal", "1/ω and V/ω evenly, V_p their quotient"),
    };
    let rows = vec![("here".to_owned(), vec![Some(hit.edges[0]), Some(hit.edges[1]), Some(hit.along)])];
    let columns = ["left edge", "right edge", "along row"].map(str::to_owned).to_vec();
    [
        field("t", "t′", Value::Table { columns, rows }),
        field("interpolation", "", Value::Text(name.to_owned())),
        field("", "formula", Value::Text(format!("{formula}; a, b: ends of the row"))),
    ]
}

/// What is to be known where t′ reaches the end of a row: only the book's scanlines do.
fn end_of_row(hit: &Hit) -> Option<Field> {
    let text = "t′ reaches or passes 1, the end of the row: a texture coordinate that ends at 1 there begins anew with the \
                address mode Repeat, and shows the first texel. Clamp, and the exact rasterizer, keep the last one";
    (hit.along >= 1.0).then(|| field("end_of_row", "note", Value::Text(text.to_owned())))
}

/// ω and all values: at the corners, at both ends of the row, and at the pixel in both ways.
fn projected_values(triangle: &FilledTriangle, hit: &Hit) -> Field {
    let count = triangle.values[0].len();
    let right_way = match triangle.interpolation {
        Interpolation::Affine => Interpolation::PerspectiveCorrect,
        other => other,
    };
    let all = |interpolation, place: usize| -> Vec<Option<f64>> {
        let first = interpolated(triangle, 0, interpolation, hit)[place].w;
        let values = (0..count).map(|k| Some(interpolated(triangle, k, interpolation, hit)[place].values[0]));
        std::iter::once(Some(first)).chain(values).collect()
    };
    let w = triangle.w.unwrap_or([1.0; 3]);
    let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    for (i, name) in ["A", "B", "C"].into_iter().enumerate() {
        let values = triangle.values[i].iter().map(|value| Some(*value));
        rows.push((name.to_owned(), std::iter::once(Some(w[i])).chain(values).collect()));
    }
    if let Some(half) = component(triangle, 0, triangle.interpolation).map(|halves| halves[hit.half]) {
        for end in [half.left.start, half.left.end, half.right.start, half.right.end] {
            let is_known = rows.iter().any(|(name, _)| name == "P′");
            if corner_name(triangle, end.position) == "P′" && !is_known {
                rows.push(("P′".to_owned(), new_corner(triangle, hit, end.position, count)));
            }
        }
    }
    let used = triangle.interpolation;
    rows.push(("row, left".to_owned(), all(used, 0)));
    rows.push(("row, right".to_owned(), all(used, 1)));
    let mark = |name: &str, is_used: bool| if is_used { format!("{name}{USED}") } else { name.to_owned() };
    rows.push((mark("affine", used == Interpolation::Affine), all(Interpolation::Affine, 2)));
    rows.push((mark("V_p", used != Interpolation::Affine), all(right_way, 2)));
    let mut columns = vec!["ω".to_owned()];
    columns.extend(value_names(count));
    field("values", "values", Value::Table { columns, rows })
}

/// What the new corner P′ carries.
fn new_corner(triangle: &FilledTriangle, hit: &Hit, position: DVec2, count: usize) -> Vec<Option<f64>> {
    let of = |k: usize| {
        let half = component(triangle, k, triangle.interpolation)?[hit.half];
        let ends = [half.left.start, half.left.end, half.right.start, half.right.end];
        ends.into_iter().find(|end| end.position == position).map(|end| end.attributes)
    };
    let values = (0..count).map(|k| of(k).map(|point| point.values[0]));
    std::iter::once(of(0).map(|point| point.w)).chain(values).collect()
}

/// Chapter 3: each value is stepped by itself.
fn stepped_values(triangle: &FilledTriangle, hit: usize, pixel: Pixel, window: Rect) -> Field {
    let count = triangle.values[0].len();
    let found: Vec<[f64; 3]> = (0..count)
        .map(|k| {
            let corners = [0, 1, 2].map(|i| [triangle.values[i][k]]);
            let limit = triangle.walk.limit;
            let ends = stepped(triangle, corners, limit, hit, pixel, window, linear);
            ends.map_or([0.0; 3], |values| values.map(|[value]| value))
        })
        .collect();
    let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    for (i, name) in ["A", "B", "C"].into_iter().enumerate() {
        rows.push((name.to_owned(), triangle.values[i].iter().map(|value| Some(*value)).collect()));
    }
    for (place, name) in ["row, left", "row, right", "here"].into_iter().enumerate() {
        rows.push((name.to_owned(), found.iter().map(|values| Some(values[place])).collect()));
    }
    field("values", "values", Value::Table { columns: value_names(count), rows })
}

/// Why a primitive did not reach a pixel that lies in its bounding box; `None` if it does not lie there.
pub(super) fn miss(primitive: &Primitive, (x, y): Pixel, window: Rect) -> Option<String> {
    match primitive {
        Primitive::Line { a, b, .. } => {
            let (low, high) = (a.min(*b).trunc(), a.max(*b));
            let place = DVec2::new(f64::from(x), f64::from(y));
            let is_inside = place.cmpge(low).all() && place.cmple(high).all();
            is_inside.then(|| "its other coordinate is cut to another pixel here".to_owned())
        }
        Primitive::Half { left, right, walk } => {
            let points = [left[0], left[1], right[0], right[1]];
            let corner = |position| Corner { position, attributes: () };
            let edge = |[start, end]: [DVec2; 2]| Edge { start: corner(start), end: corner(end) };
            row_miss(&[Half { left: edge(*left), right: edge(*right) }], &points, *walk, (x, y), window)
        }
        Primitive::Triangle(triangle) => {
            let corners = triangle.corners.map(|position| Corner { position, attributes: () });
            let halves = split(corners, |(), (), _| ()).map_or_else(Vec::new, Vec::from);
            row_miss(&halves, &triangle.corners, triangle.walk, (x, y), window)
        }
        Primitive::Coverage(coverage) => coverage.bounding_box(window).contains(x, y).then(|| {
            let unit = (SUBPIXELS * SUBPIXELS) as f64;
            let values =
                coverage.edge_values(center(x, y)).map(|value| format!("{:.3}", value as f64 / unit));
            let is_beyond = coverage.edge_values(center(x, y)).iter().any(|&value| value < 0);
            let why = if is_beyond {
                "on the wrong side of an edge"
            } else {
                "on an edge that is neither top nor left"
            };
            format!("its edge functions are {}: the center is {why}", values.join(", "))
        }),
    }
}

fn row_miss(
    halves: &[Half<()>],
    points: &[DVec2],
    walk: Walk,
    (x, y): Pixel,
    window: Rect,
) -> Option<String> {
    let place = DVec2::new(f64::from(x), f64::from(y));
    let low = points.iter().copied().reduce(DVec2::min)?.trunc();
    let high = points.iter().copied().reduce(DVec2::max)?;
    if !(place.cmpge(low).all() && place.cmple(high).all()) {
        return None;
    }
    let mut rows = Vec::new();
    for half in halves {
        half.walk(
            |_| [(), ()],
            walk,
            window,
            |span| {
                if span.y == y {
                    rows.push(format!("{:.3} to {:.3}", span.ends[0], span.ends[1]));
                }
            },
        );
    }
    if rows.is_empty() {
        return Some(format!("it has no row {y}"));
    }
    Some(format!("its row {y} runs from x = {}", rows.join(" and ")))
}
