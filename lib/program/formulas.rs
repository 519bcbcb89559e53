//! The numbers of corners, clipping, edge functions, weights and fragments, as the history of a pixel tells them. Those
//! of lines and rows are in `rows.rs`.

use super::history::{Field, Value, field, table, value_names};
use super::record::{ClipTriangle, Fragment, Pixel, Point};
use crate::area::Winding;
use crate::clip::{ClipTest, ClipVertex, Plane, clip_polygon};
use crate::edge::{Coverage, SUBPIXELS, center};
use crate::interpolate::Interpolation;
use crate::merge::Verdict;
use crate::varyings::TriangleVaryings;

/// Twice the signed area, and what it says; the label names the space in which it was reckoned.
pub(super) fn facing(area: f64, label: &'static str) -> Vec<Field> {
    let winding = match Winding::of(area) {
        Some(Winding::CounterClockwise) => "counter-clockwise",
        Some(Winding::Clockwise) => "clockwise",
        None => "none",
    };
    vec![
        field("area", label, Value::Number(area)),
        field("winding", "winding", Value::Text(winding.to_owned())),
    ]
}

/// The corners before clipping: in the model, and in clip space.
pub(super) fn vertex_fields(triangle: &ClipTriangle) -> Vec<Field> {
    let mut fields = Vec::new();
    if let Some(model) = triangle.model {
        let rows = "ABC".chars().zip(model);
        let rows = rows.map(|(name, p)| (name.to_string(), p.to_array().map(Some).to_vec())).collect();
        fields.push(field("model", "model space", table(&["x", "y", "z"], rows)));
    }
    let rows = "ABC".chars().zip(&triangle.vertices);
    let rows = rows.map(|(name, v)| (name.to_string(), v.position.to_array().map(Some).to_vec())).collect();
    fields.push(field("clip", "clip space", table(&["x", "y", "z", "ω"], rows)));
    fields
}

fn plane_name(plane: &Plane) -> String {
    let named = [
        (Plane::LEFT, "left, ω + x ≥ 0"),
        (Plane::RIGHT, "right, ω − x ≥ 0"),
        (Plane::BOTTOM, "bottom, ω + y ≥ 0"),
        (Plane::TOP, "top, ω − y ≥ 0"),
        (Plane::NEAR, "near, ω + z ≥ 0"),
        (Plane::NEAR_ZERO, "near, z ≥ 0"),
        (Plane::FAR, "far, ω − z ≥ 0"),
    ];
    let name = named.iter().find(|(known, _)| known == plane);
    name.map_or_else(
        || format!("near, ω ≥ {}", -plane.signed_distance(glam::DVec4::ZERO)),
        |(_, name)| (*name).to_owned(),
    )
}

/// How each plane changed the triangle: which vertices it cut off, and where the cuts are. New vertices are D, E, …
pub(super) fn clip_fields(triangle: &ClipTriangle) -> (Option<Field>, Vec<char>) {
    let mut names: Vec<char> = "ABC".chars().collect();
    let mut polygon: Vec<ClipVertex<0>> = triangle.vertices.iter().map(Point::bare).collect();
    let mut next = 'D';
    let mut lines = Vec::new();
    for plane in &triangle.planes {
        let distance = |vertex: &ClipVertex<0>| match triangle.test {
            ClipTest::BeforeDivide => plane.signed_distance(vertex.position),
            ClipTest::AfterDivide => plane.signed_distance(vertex.position / vertex.position.w),
        };
        let distances: Vec<f64> = polygon.iter().map(distance).collect();
        if distances.iter().all(|&distance| distance >= 0.0) {
            continue;
        }
        let mut kept = Vec::new();
        let mut line = plane_name(plane) + ":";
        for (i, &from) in distances.iter().enumerate() {
            let end = (i + 1) % distances.len();
            if from >= 0.0 {
                kept.push(names[i]);
            } else {
                line += &format!(" {} outside;", names[i]);
            }
            if (from >= 0.0) != (distances[end] >= 0.0) {
                // From the outer end to the inner one, as the clipper reckons.
                let (outer, inner) = if from >= 0.0 { (end, i) } else { (i, end) };
                let t = distances[outer] / (distances[outer] - distances[inner]);
                line += &format!(" {next} on {}{} at t = {t:.4};", names[outer], names[inner]);
                kept.push(next);
                next = char::from_u32(next as u32 + 1).unwrap_or('?');
            }
        }
        lines.push(line.trim_end_matches(';').to_owned());
        polygon = clip_polygon::<0, 16>(&polygon, plane, triangle.test).to_vec();
        names = kept;
    }
    if lines.is_empty() {
        return (None, names);
    }
    lines.push(format!(
        "left: {}",
        if names.is_empty() { "nothing".to_owned() } else { names.iter().collect() }
    ));
    (Some(field("clipping", "clipped", Value::List(lines))), names)
}

/// The three edge functions at a pixel's center, and what the weights make of the vertices.
pub(super) fn edge_fields(coverage: &Coverage, piece: Option<&[Point; 3]>, (x, y): Pixel) -> Vec<Field> {
    let unit = (SUBPIXELS * SUBPIXELS) as f64;
    let values = coverage.edge_values(center(x, y));
    let weights = values.map(|value| value as f64 / coverage.twice_area as f64);
    let corners = coverage.vertices.map(|vertex| vertex.map(|c| c as f64 / SUBPIXELS as f64));
    let rows = (0..3).map(|i| {
        let numbers = [corners[i][0], corners[i][1], values[i] as f64 / unit, weights[i]];
        (["A", "B", "C"][i].to_owned(), numbers.map(Some).to_vec())
    });
    let mut fields =
        vec![field("edges", "on the screen", table(&["x", "y", "E opposite", "weight"], rows.collect()))];
    let ties = values.iter().zip(["BC", "CA", "AB"]).filter(|(value, _)| **value == 0);
    let ties = ties.map(|(_, name)| format!("the center is on {name}, a top or left edge: covered"));
    let ties: Vec<String> = ties.collect();
    if !ties.is_empty() {
        fields.push(field("ties", "tie", Value::List(ties)));
    }
    if let Some(piece) = piece {
        fields.extend(weighted_fields(piece, [weights[1], weights[2]]));
    }
    fields
}

/// ω, and the values interpolated in both ways.
fn weighted_fields(piece: &[Point; 3], weights: [f64; 2]) -> Vec<Field> {
    let count = piece[0].values.len();
    let one = |k: usize, interpolation| {
        let corner = |i: usize| crate::clip::NdcVertex {
            position: piece[i].position.truncate(),
            w: piece[i].position.w,
            varyings: [piece[i].values.get(k).copied().unwrap_or_default()],
        };
        TriangleVaryings::<f64, 1>::new(&[corner(0), corner(1), corner(2)], interpolation).at(weights)
    };
    let all = |interpolation| (0..count).map(|k| Some(one(k, interpolation).values[0])).collect::<Vec<_>>();
    let w = |interpolation| Some(one(0, interpolation).w);
    let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    for (name, point) in ["A", "B", "C"].into_iter().zip(piece) {
        let values = point.values.iter().map(|value| Some(*value));
        rows.push((name.to_owned(), std::iter::once(Some(point.position.w)).chain(values).collect()));
    }
    for (name, interpolation) in
        [("affine", Interpolation::Affine), ("V_p", Interpolation::PerspectiveCorrect)]
    {
        rows.push((name.to_owned(), std::iter::once(w(interpolation)).chain(all(interpolation)).collect()));
    }
    let mut columns = vec!["ω".to_owned()];
    columns.extend(value_names(count));
    vec![field("values", "values", Value::Table { columns, rows })]
}

/// A fragment's ω, depth, values and color, and what became of it.
pub(super) fn fragment_fields(fragment: &Fragment) -> Vec<Field> {
    let verdict = match fragment.verdict {
        Verdict::Discarded => "discarded by the shader".to_owned(),
        Verdict::Hidden => "hidden: something nearer was there".to_owned(),
        Verdict::Drawn(color) => format!("drawn as {color:?}"),
    };
    let [red, green, blue, opacity] = fragment.color;
    let mut fields = vec![
        field("w", "ω", Value::Number(fragment.w)),
        field(
            "varyings",
            if fragment.values.is_empty() { "" } else { "varyings" },
            Value::Numbers(fragment.values.clone()),
        ),
        field("fragment_depth", "", Value::Number(fragment.depth)),
        field("shaded", "shader's color", Value::Numbers(vec![red, green, blue])),
    ];
    if opacity < 1.0 {
        fields.push(field("opacity", "opacity", Value::Number(opacity)));
    }
    fields.push(field("verdict", "fragment", Value::Text(verdict)));
    fields
}
