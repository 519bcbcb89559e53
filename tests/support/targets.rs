//! Comparing what two rasterizers have drawn, to the last bit.

use rasterbook::Target;

/// Panics at the first pixel whose color or depth is not the same. What is not a number is that in both: there are many
/// ways to write it, and machines choose.
pub(crate) fn assert_same(tiled: &Target<f32>, exact: &Target<f32>) {
    assert_eq!((tiled.color.rect(), tiled.depth.rect()), (exact.color.rect(), exact.depth.rect()));
    // At once, since that is quicker, and they hardly ever are not.
    let mut rows = tiled.depth.rows_from_top().zip(exact.depth.rows_from_top());
    if tiled.color == exact.color && rows.all(|(these, those)| have_same_bits(these, those)) {
        return;
    }
    for (x, y) in exact.color.rect().pixels() {
        let depths = [tiled, exact].map(|target| target.depth.get(x, y).expect("inside"));
        assert!(is_same(depths), "depths {depths:?} at ({x}, {y})");
        assert_eq!(tiled.color.get(x, y), exact.color.get(x, y), "color at ({x}, {y})");
    }
}

/// Whether all bits of two rows are the same. NaNs that are written in different ways differ here.
fn have_same_bits(these: &[f32], those: &[f32]) -> bool {
    // No branch: this is done for every pixel of every picture.
    let differing = |bits, (a, b): (&f32, &f32)| bits | (a.to_bits() ^ b.to_bits());
    these.iter().zip(those).fold(0, differing) == 0
}

/// Whether two depths are the same, or none is a number.
fn is_same([a, b]: [f32; 2]) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}
