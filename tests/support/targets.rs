//! Comparing what two rasterizers have drawn, to the last bit.

use rasterbook::Target;

/// Panics at the first pixel whose color or depth is not the same.
pub(crate) fn assert_same(tiled: &Target<f32>, exact: &Target<f32>) {
    for y in exact.color.rect().rows() {
        for x in exact.color.rect().columns() {
            let depths = [tiled, exact].map(|target| target.depth.get(x, y).expect("inside").to_bits());
            assert_eq!(depths[0], depths[1], "depth at ({x}, {y})");
            let colors = [tiled, exact].map(|target| target.color.get(x, y).expect("inside"));
            assert_eq!(colors[0], colors[1], "color at ({x}, {y})");
        }
    }
}
