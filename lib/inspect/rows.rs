//! The numbers of the line and of the scanline walk at one pixel, found by walking once more.

use glam::DVec2;

use super::event::Primitive;
use super::history::{Field, USED, Value, field, table, value_names};
use crate::exact::edge::{Coverage, SUBPIXELS, center};
use crate::interpolate::{
    EdgeParameter, Interpolation, Projected, ScreenTriangle, attach_depths, ends_of_row, linear,
};
use crate::line::Line;
use crate::payload::{Payload, Walk};
use crate::rect::{Pixel, Rect};
use crate::scanline::{Edge, EdgeWalk, Half, HalfFill, split};

/// The step of a line that drew a pixel.
pub(super) fn line_at(line: &Line, pixel: Pixel, screen: Rect) -> Vec<Field> {
    let ends = [("a", line.a), ("b", line.b)];
    let ends = ends.map(|(name, p)| (name.to_owned(), p.to_array().map(Some).to_vec())).to_vec();
    let mut fields = vec![
        field("ends", "on the screen", table(&["x", "y"], ends)),
        field("slope", "k = Δy/Δx", Value::Number(line.slope())),
    ];
    let (visible, [running, other], [low, high]) = if line.is_x_major() {
        (screen.columns(), ["x", "y"], [line.a.x, line.b.x])
    } else {
        (screen.rows(), ["y", "x"], [line.a.y, line.b.y])
    };
    let start = low.min(high);
    line.step(visible, |at, [along, across]| {
        if at == pixel {
            fields.push(field("step", "step", Value::Whole((along - start).round() as i64)));
            fields.push(field("along", "", Value::Number(along)));
            fields.push(field("across", "", Value::Number(across)));
            let (x, y) = pixel;
            let text = format!("{running} = {along:.4}, {other} = {across:.4}, cut to ({x}, {y})");
            fields.push(field("", "running", Value::Text(text)));
        }
    });
    fields
}

/// Which row of which half met a pixel, with what was stepped on the way.
#[derive(Clone, Copy)]
struct Hit {
    half: usize,
    /// Where the row begins and ends.
    ends: [f64; 2],
    /// On the left and on the right edge.
    edges: [EdgeParameter; 2],
    /// Along the row.
    here: EdgeParameter,
}

/// What a payload is, each time that the walk up a half meets a pixel: at the start of the row, at its end, and there.
/// With the ends of the row.
fn payload_at<P: Payload>(
    half: &Half,
    carried: &Half<P>,
    walk: Walk,
    (x, y): Pixel,
    screen: Rect,
    row_payload: impl Fn([P; 2]) -> [P; 2],
) -> Vec<([f64; 2], [P; 3])> {
    let mut found = Vec::new();
    half.step(carried, walk, screen, |span, ends| {
        if span.y == y {
            let [from, to] = row_payload(ends);
            span.step(from, to, walk.clamp, |column, here| {
                if column == x {
                    found.push(([span.start, span.end], [ends[0], ends[1], here]));
                }
            });
        }
    });
    found
}

/// Walks a half with the parameter t as its payload, and a depth beside it.
fn hits_of(
    (index, half, depths): (usize, &Half, &Half<f64>),
    walk: Walk,
    pixel: Pixel,
    screen: Rect,
) -> Vec<Hit> {
    let carried = EdgeParameter::on(depths);
    let found = payload_at(half, &carried, walk, pixel, screen, EdgeParameter::along_row);
    let hit = |(ends, [left, right, here]): ([f64; 2], [EdgeParameter; 3])| Hit {
        half: index,
        ends,
        edges: [left, right],
        here,
    };
    found.into_iter().map(hit).collect()
}

/// For each time that a triangle, or half of one, met the pixel: the fields.
pub(super) fn rows_at(primitive: &Primitive, pixel: Pixel, screen: Rect) -> Vec<Vec<Field>> {
    match primitive {
        Primitive::Half(HalfFill { half: half @ Half { left, right }, edges }) => {
            let rows = [
                ("left, from", left.start),
                ("left, to", left.end),
                ("right, from", right.start),
                ("right, to", right.end),
            ];
            let rows = rows.map(|(name, p)| (name.to_owned(), p.to_array().map(Some).to_vec())).to_vec();
            let sides = field("sides", "on the screen", table(&["x", "y"], rows));
            let walk = Walk { edges: *edges, ..Walk::default() };
            let nowhere = Edge { start: 0.0, end: 0.0 };
            let depths = Half { left: nowhere, right: nowhere };
            let hits = hits_of((0, half, &depths), walk, pixel, screen);
            hits.iter().map(|hit| vec![sides.clone(), row_text("", hit, pixel)]).collect()
        }
        Primitive::Triangle(triangle) => triangle_hits(triangle, pixel, screen),
        Primitive::Line(_) | Primitive::Coverage(_) => Vec::new(),
    }
}

fn row_text(half: &str, hit: &Hit, (x, y): Pixel) -> Field {
    let [start, end] = hit.ends;
    let text = format!("{half}y = {y}, from x = {start:.4} to {end:.4}; here x = {x}");
    field("row", "row", Value::Text(text))
}

/// The halves of a triangle on the screen, the lower one first.
fn halves(triangle: &ScreenTriangle) -> Vec<Half> {
    split(triangle.positions).map_or_else(Vec::new, |split| vec![split.lower, split.upper])
}

/// One value of a triangle's vertices with ω, as it is carried by the halves' edges.
fn component(
    triangle: &ScreenTriangle,
    k: usize,
    interpolation: Interpolation,
) -> Option<[Half<Projected<f64, 1>>; 2]> {
    let w = triangle.w.unwrap_or([1.0; 3]);
    let value = |i: usize| triangle.varyings[i].get(k).copied().unwrap_or_default();
    let points = [0, 1, 2].map(|i| Projected { w: w[i], values: [value(i)] });
    Some(split(triangle.positions)?.attach(points, |a, b, t| interpolation.between(a, b, t)))
}

/// ω and a value at the left end of the row, at its right end, and at the pixel.
fn interpolated(
    triangle: &ScreenTriangle,
    k: usize,
    interpolation: Interpolation,
    hit: &Hit,
) -> [Projected<f64, 1>; 3] {
    let Some(halves) = component(triangle, k, interpolation) else {
        return [Projected { w: 0.0, values: [0.0] }; 3];
    };
    let [left, right] = ends_of_row(&halves[hit.half], hit.edges.map(|edge| edge.t), interpolation);
    [left, right, interpolation.between(left, right, hit.here.t)]
}

/// A value of chapter 3, which is stepped by itself: at both ends of the row, and at the pixel, which is met for the
/// `hit`th time.
fn stepped(
    triangle: &ScreenTriangle,
    values: [f64; 3],
    hit: usize,
    pixel: Pixel,
    screen: Rect,
) -> Option<[f64; 3]> {
    let split = split(triangle.positions)?;
    let carried = split.attach(values, |a, b, t| linear([a], [b], t)[0]);
    let halves = [split.lower, split.upper].into_iter().zip(carried);
    let mut found = halves
        .flat_map(|(half, carried)| payload_at(&half, &carried, triangle.walk, pixel, screen, |ends| ends));
    found.nth(hit).map(|(_, values)| values)
}

fn triangle_hits(triangle: &ScreenTriangle, pixel: Pixel, screen: Rect) -> Vec<Vec<Field>> {
    let Some(split) = split(triangle.positions) else { return Vec::new() };
    let depths = attach_depths(&split, triangle.depth.unwrap_or_default());
    let halves = [split.lower, split.upper];
    let hits = (0..2).flat_map(|i| hits_of((i, &halves[i], &depths[i]), triangle.walk, pixel, screen));
    hits.enumerate().map(|(i, hit)| hit_fields(triangle, i, &hit, pixel, screen)).collect()
}

/// What happened when a triangle met the pixel for the `number`th time.
fn hit_fields(triangle: &ScreenTriangle, number: usize, hit: &Hit, pixel: Pixel, screen: Rect) -> Vec<Field> {
    let mut fields = screen_fields(triangle, hit, pixel);
    if triangle.w.is_none() {
        fields.push(stepped_values(triangle, number, pixel, screen));
        return fields;
    }
    fields.extend(parameters(triangle, hit));
    fields.extend(end_of_row(hit));
    fields.push(projected_values(triangle, hit));
    if triangle.depth.is_some() {
        let rows = [("left", hit.edges[0]), ("right", hit.edges[1]), ("here", hit.here)];
        let rows = rows.map(|(name, at)| (name.to_owned(), vec![Some(at.depth)])).to_vec();
        fields.push(field("depths", "depth, stepped", table(&["z"], rows)));
    }
    fields
}

/// The vertices on the screen, P′ among them, and the row.
fn screen_fields(triangle: &ScreenTriangle, hit: &Hit, pixel: Pixel) -> Vec<Field> {
    let half = halves(triangle).get(hit.half).copied();
    let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    for (i, name) in ["A", "B", "C"].into_iter().enumerate() {
        let [x, y] = triangle.positions[i].to_array();
        let numbers = [Some(x), Some(y), triangle.w.map(|w| w[i]), triangle.depth.map(|depth| depth[i])];
        rows.push((name.to_owned(), numbers.to_vec()));
    }
    let mut text = String::new();
    if let Some(half) = half {
        for (name, edge) in [("left", half.left), ("right", half.right)] {
            text +=
                &format!("{name} {}{}, ", vertex_name(triangle, edge.start), vertex_name(triangle, edge.end));
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

/// A, B, C, or the new point P′ on the long edge.
fn vertex_name(triangle: &ScreenTriangle, position: DVec2) -> &'static str {
    let known = triangle.positions.iter().position(|vertex| *vertex == position);
    known.map_or("P′", |i| ["A", "B", "C"][i])
}

/// t on both edges and t′ along the row, and what is made of them.
fn parameters(triangle: &ScreenTriangle, hit: &Hit) -> [Field; 3] {
    let (name, formula) = match triangle.interpolation {
        Interpolation::Affine => ("affine", "V = Va + (Vb − Va) t′"),
        Interpolation::PerspectiveCorrect => {
            ("perspective-correct", "V_p = (ωb Va + (ωa Vb − ωb Va) t′) / (ωb + (ωa − ωb) t′)")
        }
        Interpolation::Reciprocal => ("reciprocal", "1/ω and V/ω linearly, V_p their quotient"),
    };
    let rows = vec![("here".to_owned(), vec![Some(hit.edges[0].t), Some(hit.edges[1].t), Some(hit.here.t)])];
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
    (hit.here.t >= 1.0).then(|| field("end_of_row", "note", Value::Text(text.to_owned())))
}

/// ω and all values: at the vertices, at both ends of the row, and at the pixel in both ways.
fn projected_values(triangle: &ScreenTriangle, hit: &Hit) -> Field {
    let count = triangle.varyings[0].len();
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
        let values = triangle.varyings[i].iter().map(|value| Some(*value));
        rows.push((name.to_owned(), std::iter::once(Some(w[i])).chain(values).collect()));
    }
    if let Some(new) = new_point(triangle, hit, count) {
        rows.push(("P′".to_owned(), new));
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

/// What the new point P′ carries, if it is no vertex itself.
fn new_point(triangle: &ScreenTriangle, hit: &Hit, count: usize) -> Option<Vec<Option<f64>>> {
    fn ends<T: Copy>(half: &Half<T>) -> [T; 4] {
        [half.left.start, half.left.end, half.right.start, half.right.end]
    }
    let half = *halves(triangle).get(hit.half)?;
    let place = ends(&half).into_iter().position(|end| vertex_name(triangle, end) == "P′")?;
    let of = |k: usize| Some(ends(&component(triangle, k, triangle.interpolation)?[hit.half])[place]);
    let values = (0..count).map(|k| of(k).map(|point| point.values[0]));
    Some(std::iter::once(of(0).map(|point| point.w)).chain(values).collect())
}

/// Chapter 3: each value is stepped by itself.
fn stepped_values(triangle: &ScreenTriangle, hit: usize, pixel: Pixel, screen: Rect) -> Field {
    let count = triangle.varyings[0].len();
    let found: Vec<[f64; 3]> = (0..count)
        .map(|k| {
            let values = [0, 1, 2].map(|i| triangle.varyings[i][k]);
            stepped(triangle, values, hit, pixel, screen).unwrap_or_default()
        })
        .collect();
    let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    for (i, name) in ["A", "B", "C"].into_iter().enumerate() {
        rows.push((name.to_owned(), triangle.varyings[i].iter().map(|value| Some(*value)).collect()));
    }
    for (place, name) in ["row, left", "row, right", "here"].into_iter().enumerate() {
        rows.push((name.to_owned(), found.iter().map(|values| Some(values[place])).collect()));
    }
    field("values", "values", Value::Table { columns: value_names(count), rows })
}

/// Why a primitive did not reach a pixel that lies in its bounding box; `None` if it does not lie there.
pub(super) fn miss(primitive: &Primitive, pixel: Pixel, screen: Rect) -> Option<String> {
    match primitive {
        Primitive::Line(Line { a, b, .. }) => is_in_box(&[*a, *b], pixel)
            .then(|| "its other coordinate is cut to another pixel here".to_owned()),
        Primitive::Half(HalfFill { half: half @ Half { left, right }, edges }) => {
            let points = [left.start, left.end, right.start, right.end];
            is_in_box(&points, pixel).then(|| row_miss(&[*half], *edges, pixel, screen))
        }
        Primitive::Triangle(triangle) => is_in_box(&triangle.positions, pixel)
            .then(|| row_miss(&halves(triangle), triangle.walk.edges, pixel, screen)),
        Primitive::Coverage(coverage) => {
            let (x, y) = pixel;
            coverage.bounding_box(screen).contains(x, y).then(|| edge_miss(coverage, pixel))
        }
    }
}

/// Whether a pixel lies in the box around some points.
fn is_in_box(points: &[DVec2], (x, y): Pixel) -> bool {
    let place = DVec2::new(f64::from(x), f64::from(y));
    let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min).trunc();
    let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    place.cmpge(low).all() && place.cmple(high).all()
}

fn row_miss(halves: &[Half], edges: EdgeWalk, (_, y): Pixel, screen: Rect) -> String {
    let mut rows = Vec::new();
    for half in halves {
        half.spans(edges, screen, |span| {
            if span.y == y {
                rows.push(format!("{:.3} to {:.3}", span.start, span.end));
            }
        });
    }
    if rows.is_empty() {
        return format!("it has no row {y}");
    }
    format!("its row {y} runs from x = {}", rows.join(" and "))
}

fn edge_miss(coverage: &Coverage, (x, y): Pixel) -> String {
    let unit = (SUBPIXELS * SUBPIXELS) as f64;
    let values = coverage.edge_values(center(x, y));
    let is_beyond = values.iter().any(|&value| value < 0);
    let values = values.map(|value| format!("{:.3}", value as f64 / unit));
    let why =
        if is_beyond { "on the wrong side of an edge" } else { "on an edge that is neither top nor left" };
    format!("its edge functions are {}: the center is {why}", values.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn a_box_begins_with_the_pixel_of_its_lowest_point() {
        let points = [dvec2(1.5, 7.9), dvec2(4.0, 2.0)];
        for inside in [(1, 2), (4, 7), (2, 5)] {
            assert!(is_in_box(&points, inside), "{inside:?}");
        }
        for outside in [(0, 5), (5, 5), (2, 1), (2, 8)] {
            assert!(!is_in_box(&points, outside), "{outside:?}");
        }
    }

    #[test]
    fn why_a_pixel_of_the_box_was_missed() {
        let screen = Rect::sized(16, 16);
        let said = |triangle, pixel| {
            let coverage = Coverage::new(triangle).expect("an area");
            miss(&Primitive::Coverage(coverage), pixel, screen)
        };
        let triangle = [dvec2(0.5, 0.5), dvec2(8.5, 0.5), dvec2(0.5, 8.5)];
        let functions =
            |values: &str, why: &str| Some(format!("its edge functions are {values}: the center is {why}"));
        assert_eq!(
            said(triangle, (6, 6)),
            functions("-32.000, 48.000, 48.000", "on the wrong side of an edge")
        );
        assert_eq!(
            said(triangle, (4, 4)),
            functions("0.000, 32.000, 32.000", "on an edge that is neither top nor left")
        );
        assert_eq!(said(triangle, (9, 9)), None, "not in the box");
    }
}
