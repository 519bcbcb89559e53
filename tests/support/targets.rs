//! Comparing what two rasterizers have drawn, to the last bit.

use rasterbook::Target;

/// Panics at the first pixel whose color or depth is not the same. What is not a number is that in both: there are many
/// ways to write it, and machines choose.
pub(crate) fn assert_same(tiled: &Target<f32>, exact: &Target<f32>) {
    // At once, since that is quicker, and they hardly ever are not.
    let has_other_colors = tiled.color != exact.color;
    for y in exact.color.rect().rows() {
        for x in exact.color.rect().columns() {
            let depths = (tiled.depth.get(x, y), exact.depth.get(x, y));
            let is_same = match depths {
                (Some(a), Some(b)) => a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()),
                _ => false,
            };
            assert!(is_same, "depths {depths:?} at ({x}, {y})");
            if has_other_colors {
                assert_eq!(tiled.color.get(x, y), exact.color.get(x, y), "color at ({x}, {y})");
            }
        }
    }
    assert!(!has_other_colors, "{:?} and {:?} pixels", tiled.color.rect(), exact.color.rect());
}
