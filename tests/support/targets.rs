//! Comparing what two rasterizers have drawn, to the last bit.

use rasterbook::Target;

/// Panics at the first pixel whose color or depth is not the same. What is not a number is that in both: there are many
/// ways to write it, and machines choose.
pub(crate) fn assert_same(tiled: &Target<f32>, exact: &Target<f32>) {
    for y in exact.color.rect().rows() {
        for x in exact.color.rect().columns() {
            let depths = [tiled, exact].map(|target| target.depth.get(x, y).expect("inside"));
            let is_same =
                depths[0].to_bits() == depths[1].to_bits() || depths.iter().all(|depth| depth.is_nan());
            assert!(is_same, "depths {depths:?} at ({x}, {y})");
            let colors = [tiled, exact].map(|target| target.color.get(x, y).expect("inside"));
            assert_eq!(colors[0], colors[1], "color at ({x}, {y})");
        }
    }
}
