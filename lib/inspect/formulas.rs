//! The numbers of vertices, clipping, edge functions, weights and fragments, as the history of a pixel has them. Those
//! of lines and rows are in `rows.rs`.

use super::history::{Field, Value, field, table, value_names};
use crate::area::Winding;
use crate::clip::{Assembled, Clip, ClipVertex, NdcVertex, Plane, clip_polygon, for_each_clip};
use crate::exact::edge::{Coverage, SUBPIXELS, center};
use crate::interpolate::Interpolation;
use crate::merge::Verdict;
use crate::probe::{Fragment, Piece};
use crate::rect::Pixel;
use crate::varyings::TriangleVaryings;

/// Twice the signed area, and what it says; the label names the space in which it was computed.
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

/// The vertices before clipping: in the model, and in clip space.
pub(super) fn vertex_fields(triangle: &Assembled) -> Vec<Field> {
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
pub(super) fn clip_fields(triangle: &Assembled) -> (Option<Field>, Vec<char>) {
    let mut names: Vec<char> = "ABC".chars().collect();
    let mut new_names = 'D'..;
    let mut polygon: Vec<ClipVertex<0>> = triangle.vertices.iter().map(ClipVertex::from).collect();
    let mut lines = Vec::new();
    for plane in &triangle.planes {
        let mut kept = Vec::new();
        let mut parts = Vec::new();
        for_each_clip(&polygon, plane, triangle.test, |clip| match clip {
            Clip::Inside(vertex) => kept.push(names[vertex]),
            Clip::Outside(vertex) => parts.push(format!(" {} outside", names[vertex])),
            Clip::Cut { outer, inner, t } => {
                let new = new_names.next().unwrap_or('?');
                parts.push(format!(" {new} on {}{} at t = {t:.4}", names[outer], names[inner]));
                kept.push(new);
            }
        });
        if !parts.is_empty() {
            lines.push(format!("{}:{}", plane_name(plane), parts.join(";")));
            polygon = clip_polygon::<0, 16>(&polygon, plane, triangle.test).to_vec();
            names = kept;
        }
    }
    if lines.is_empty() {
        return (None, names);
    }
    let left = if names.is_empty() { "nothing".to_owned() } else { names.iter().collect() };
    lines.push(format!("left: {left}"));
    (Some(field("clipping", "clipped", Value::List(lines))), names)
}

/// The three edge functions at a pixel's center, and what the weights make of the vertices.
pub(super) fn edge_fields(coverage: &Coverage, piece: Option<&Piece>, (x, y): Pixel) -> Vec<Field> {
    let unit = (SUBPIXELS * SUBPIXELS) as f64;
    let values = coverage.edge_values(center(x, y));
    let weights = values.map(|value| value as f64 / coverage.twice_area as f64);
    let vertices = coverage.vertices.map(|vertex| vertex.map(|c| c as f64 / SUBPIXELS as f64));
    let rows = (0..3).map(|i| {
        let numbers = [vertices[i][0], vertices[i][1], values[i] as f64 / unit, weights[i]];
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
fn weighted_fields(Piece { vertices, .. }: &Piece, weights: [f64; 2]) -> Vec<Field> {
    let count = vertices[0].varyings.len();
    let one = |k: usize, interpolation| {
        let triangle = vertices.each_ref().map(|vertex| NdcVertex {
            position: vertex.position.truncate(),
            w: vertex.position.w,
            varyings: [vertex.varyings.get(k).copied().unwrap_or_default()],
        });
        TriangleVaryings::<f64, 1>::new(&triangle, interpolation).at(weights)
    };
    let all = |interpolation| (0..count).map(|k| Some(one(k, interpolation).values[0])).collect::<Vec<_>>();
    let w = |interpolation| Some(one(0, interpolation).w);
    let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    for (name, vertex) in ["A", "B", "C"].into_iter().zip(vertices) {
        let values = vertex.varyings.iter().map(|value| Some(*value));
        rows.push((name.to_owned(), std::iter::once(Some(vertex.position.w)).chain(values).collect()));
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
            if fragment.varyings.is_empty() { "" } else { "varyings" },
            Value::Numbers(fragment.varyings.clone()),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;
    use glam::dvec2;

    #[test]
    fn an_area_says_the_winding() {
        for (area, winding) in [(2.0, "counter-clockwise"), (-2.0, "clockwise"), (0.0, "none")] {
            let fields = facing(area, "area");
            assert!(matches!(&fields[0].value, Value::Number(number) if *number == area));
            assert!(matches!(&fields[1].value, Value::Text(text) if text == winding), "{area}");
        }
    }

    #[test]
    fn opacity_is_told_where_something_shines_through() {
        let has_opacity = |opacity| {
            let color = [1.0, 2.0, 3.0, opacity];
            let verdict = Verdict::Drawn(Color::RED);
            let fragment = Fragment { w: 1.0, depth: 0.5, varyings: vec![], color, verdict };
            fragment_fields(&fragment).iter().any(|field| field.key == "opacity")
        };
        assert_eq!([0.5, 1.0].map(has_opacity), [true, false]);
    }

    #[test]
    fn edge_functions_are_told_in_pixels() {
        let triangle = [dvec2(0.5, 0.5), dvec2(8.5, 0.5), dvec2(0.5, 8.5)];
        let fields = edge_fields(&Coverage::new(triangle).expect("an area"), None, (2, 1));
        let Value::Table { rows, .. } = &fields[0].value else { panic!("no table: {fields:?}") };
        let expected = [[0.5, 0.5, 40.0, 0.625], [8.5, 0.5, 16.0, 0.25], [0.5, 8.5, 8.0, 0.125]];
        for (row, expected) in rows.iter().zip(expected) {
            assert_eq!(row.1, expected.map(Some), "{}", row.0);
        }
        assert_eq!((rows.len(), fields.len()), (3, 1), "on no edge");
    }

    #[test]
    fn planes_have_names() {
        assert_eq!(plane_name(&Plane::NEAR_ZERO), "near, z ≥ 0");
        assert_eq!(plane_name(&Plane::in_front(0.5)), "near, ω ≥ 0.5");
    }
}
