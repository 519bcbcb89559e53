//! Beyond the book: which pixels a triangle covers, and several samples in a pixel.

use glam::dvec2;
use rasterbook::exact::edge::{Coverage, EdgeFunction, SUBPIXELS, center, snap};
use rasterbook::exact::samples::{GRID_2X2, GRID_4X4, ROTATED_4};

use super::*;

/// Triangles up to where vertices are too far away to be drawn, and on it.
fn near_triangle() -> impl Strategy<Value = [DVec2; 3]> {
    const NEAR: [f64; 9] = [-65_536.0, 65_536.0, 65_536.01, 0.0, -0.0, 5e-324, 0.001_953_125, -2.5, 7.75];
    let near = prop::array::uniform6(prop_oneof![4 => select(&NEAR[..]), 1 => -30.0..30.0]);
    let near = near.prop_map(|[a, b, c, d, e, f]| [dvec2(a, b), dvec2(c, d), dvec2(e, f)]);
    prop_oneof![8 => near, 1 => triangle()]
}

fn assert_coverage(coverage: &Coverage, rect: Rect, far: Rect) {
    assert_eq!(Winding::of(coverage.signed_area()), Some(coverage.winding));
    let near = coverage.pixels(rect).chain(coverage.all_pixels(rect));
    for (x, y, values) in near.chain(coverage.all_pixels(far)) {
        assert!(rect.contains(x, y) || far.contains(x, y));
        assert_eq!(values, coverage.edge_values(center(x, y)));
        assert_eq!(values.map(i128::from).iter().sum::<i128>(), i128::from(coverage.twice_area));
        let [second, third] = coverage.weights::<f64>(values);
        assert!(!coverage.covers(values) || (second >= 0.0 && third >= 0.0 && second + third <= 1.001));
    }
}

proptest! {
    #[test]
    fn coverage_is_exact_as_far_as_vertices_go(
        triangle in near_triangle(), rect in small_rect(), whole in any_rect(), x in any_whole(), y in any_whole(),
    ) {
        for vertex in triangle {
            let snapped = snap(vertex);
            assert_eq!(snapped.is_some(), vertex.abs().max_element() <= 65_536.0 && !vertex.is_nan());
            assert!(snapped.is_none_or(|vertex| vertex.iter().all(|c| c.abs() <= 1 << 24)));
        }
        let [a, b, _] = triangle.map(snap);
        if let (Some(a), Some(b)) = (a, b) {
            let [there, back] = [EdgeFunction::new(a, b), EdgeFunction::new(b, a)];
            assert_eq!([there.at(a), there.at(b), back.at(a)], [0; 3]);
            // A point on an edge belongs to one of two neighbors; without length there is no edge.
            assert_eq!(there.is_top_left() != back.is_top_left(), a != b);
            assert!(there.covers(0) == there.is_top_left() && there.covers(1) && !there.covers(-1));
            assert!(there.covers(i64::MAX) && !there.covers(i64::MIN));
        }
        // Edge functions are exact so far.
        let (end, [left, bottom]) = (1 << 28, [rect.left >> 4, rect.bottom >> 4]);
        let rect = Rect { left, bottom, right: left + 5, top: bottom + 5 };
        for far in [Rect { left: end - 2, right: end, ..rect }, Rect { bottom: -end, top: 2 - end, ..rect }] {
            if let Some(coverage) = Coverage::new(triangle) {
                assert_coverage(&coverage, rect, far);
                let bounds = coverage.bounding_box(whole);
                assert_eq!(bounds, bounds.intersection(whole));
                let columns = coverage.covered_columns(whole.columns(), y);
                assert!(columns.is_empty() || (whole.left <= columns.start && columns.end <= whole.right));
                assert!(!columns.contains(&x) || bounds.left <= x && x < bounds.right);
                let [[dx, _], [dy, _]] = coverage.weight_gradients::<f32>();
                assert!(dx.is_finite() && dy.is_finite() && coverage.weight_step::<f64>()[1].is_finite());
            }
        }
    }

    #[test]
    fn samples_outside_are_left_alone(
        x in any_whole(), y in any_whole(), sample in select(&[0, 3, 4, usize::MAX][..]), depth in any_number(),
    ) {
        for pattern in [&CENTER[..], &GRID_2X2, &ROTATED_4, &GRID_4X4] {
            let mut framebuffer = Framebuffer::new(3, 2);
            framebuffer.set_observer(Some(Arc::new(Curious)));
            let mut samples = Samples::like(&framebuffer, pattern);
            samples.draw(x, y, sample, depth, Color::WHITE);
            let is_drawn = samples.rect().contains(x, y) && sample < pattern.len() && !depth.is_nan();
            let picture = samples.resolved();
            assert_eq!(picture != framebuffer, is_drawn);
            let [left, bottom] = [x, y].map(|i| i64::from(i) * SUBPIXELS);
            for (number, [x, y]) in samples.of_pixel(x, y) {
                assert!(number < pattern.len() && x - left < SUBPIXELS && y - bottom < SUBPIXELS);
            }
            assert_eq!(Samples::new(3, 2, pattern).rect(), Target::<f32>::like(&picture).color.rect());
        }
    }
}
