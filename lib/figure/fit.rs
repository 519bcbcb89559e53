//! How a scene that is made for a picture of one size is laid into a picture of another.

use glam::DVec2;

use crate::interpolate::ScreenVertex;
use crate::rect::{Pixel, Rect};
use crate::transform::Viewport;

/// A scene in a picture: as large as it fits, its proportions kept, in the middle.
///
/// In a picture of the scene's own size every point stays what it is, bit for bit.
///
/// ```
/// use rasterbook::Rect;
/// use rasterbook::figure::Fit;
/// use rasterbook::glam::dvec2;
///
/// // A scene for 640×480 in a picture that is higher and much wider: 240 pixels are left free on either side.
/// let fit = Fit::new(Rect::sized(1920, 1080), [640.0, 480.0]);
/// assert_eq!(fit.scale, 2.25);
/// assert_eq!(fit.at(dvec2(0.0, 0.0)), dvec2(240.0, 0.0));
/// assert_eq!(fit.at(dvec2(640.0, 480.0)), dvec2(1680.0, 1080.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// How many pixels of the picture one of the scene becomes.
    pub scale: f64,
    /// Where the scene's lower left vertex comes to lie.
    origin: DVec2,
}

impl Fit {
    /// Lays a scene of this width and height into a picture, where [`Viewport::fitting`] lays one of their proportions.
    #[must_use]
    pub fn new(picture: Rect, [width, height]: [f64; 2]) -> Self {
        let room = Viewport::fitting(picture, width / height);
        let scale = (room.width / width).min(room.height / height);
        Self { scale, origin: DVec2::new(room.x, room.y) }
    }

    /// A scene whose lower left vertex is at a pixel, each of its units as large as so many pixels.
    pub(super) fn placed((x, y): Pixel, scale: u32) -> Self {
        Self { scale: scale.into(), origin: DVec2::new(x.into(), y.into()) }
    }

    /// Where a point of the scene is in the picture.
    #[must_use]
    pub fn at(&self, point: DVec2) -> DVec2 {
        self.origin + point * self.scale
    }

    /// Which point of the scene is at a point of the picture.
    #[must_use]
    pub fn back(&self, point: DVec2) -> DVec2 {
        (point - self.origin) / self.scale
    }

    /// Where a triangle of the scene is in the picture; what its vertices carry stays.
    #[must_use]
    pub fn triangle<V>(&self, triangle: [ScreenVertex<V>; 3]) -> [ScreenVertex<V>; 3] {
        triangle.map(|vertex| ScreenVertex { position: self.at(vertex.position), ..vertex })
    }

    /// Where a rectangle of the scene is in the picture, its borders on whole pixels.
    #[must_use]
    pub fn rect(&self, rect: Rect) -> Rect {
        let at = |x: i32, y: i32| self.at(DVec2::new(x.into(), y.into())).round().to_array();
        let ([left, bottom], [right, top]) = (at(rect.left, rect.bottom), at(rect.right, rect.top));
        let [left, bottom, right, top] = [left, bottom, right, top].map(|border| border as i32);
        Rect { left, bottom, right, top }
    }

    /// A mark around a point of the picture: in the scene it reaches so many pixels to each side.
    #[must_use]
    pub fn mark(&self, point: DVec2, reach: f64) -> Rect {
        let (x, y, reach) = (point.x as i32, point.y as i32, (reach * self.scale).round() as i32);
        let [left, bottom] = [x, y].map(|first| first.saturating_sub(reach));
        let [right, top] = [x, y].map(|last| last.saturating_add(reach).saturating_add(1));
        Rect { left, bottom, right, top }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn at_its_own_size_a_scene_stays_what_it_is() {
        for (width, height) in [(640, 480), (480, 480), (632, 208), (800, 400), (760, 400), (320, 320)] {
            let fit = Fit::new(Rect::sized(width, height), [width.into(), height.into()]);
            assert_eq!((fit.scale, fit.origin), (1.0, DVec2::ZERO));
            for i in 0..100 {
                let point = dvec2(415.692193816530, 0.1) * f64::from(i) / 7.0;
                assert_eq!(fit.at(point).to_array().map(f64::to_bits), point.to_array().map(f64::to_bits));
            }
            let rect = Rect { left: -4, bottom: 3, right: 7, top: 15 };
            assert_eq!(fit.rect(rect), rect);
        }
    }

    #[test]
    fn it_lies_where_the_viewport_does() {
        for (width, height) in [(1280, 720), (300, 300), (1920, 1080), (333, 77), (1, 1), (1, 999)] {
            let picture = Rect::sized(width, height);
            let viewport = Viewport::fitting(picture, 640.0 / 480.0);
            let fit = Fit::new(picture, [640.0, 480.0]);
            assert_eq!(fit.at(DVec2::ZERO), dvec2(viewport.x, viewport.y));
            let size = fit.at(dvec2(640.0, 480.0)) - fit.at(DVec2::ZERO);
            // The viewport has whole pixels, the fit one scale for both directions.
            let rest = dvec2(viewport.width, viewport.height) - size;
            assert!(rest.min_element() > -1e-9 && rest.max_element() < 1.0, "{width}×{height}: {rest}");
        }
    }

    #[test]
    fn there_and_back() {
        let fit = Fit::new(Rect::sized(1920, 1080), [640.0, 480.0]);
        assert_eq!(fit.back(fit.at(dvec2(12.0, 34.5))), dvec2(12.0, 34.5));
    }

    #[test]
    fn a_triangle_is_placed_and_carries_what_it_did() {
        let fit = Fit::new(Rect::sized(1920, 1080), [640.0, 480.0]);
        let corners = [(0.0, 0.0), (640.0, 0.0), (0.0, 480.0)];
        let triangle = corners.map(|(x, y)| ScreenVertex { position: dvec2(x, y), varyings: x + y });
        let placed = fit.triangle(triangle);
        assert_eq!(placed.map(|vertex| vertex.position), triangle.map(|vertex| fit.at(vertex.position)));
        assert_eq!(placed.map(|vertex| vertex.varyings), [0.0, 640.0, 480.0]);
    }

    #[test]
    fn a_mark_grows_with_the_scene() {
        let fit = Fit::new(Rect::sized(1280, 960), [640.0, 480.0]);
        let mark = fit.mark(fit.at(dvec2(10.0, 20.0)), 4.0);
        assert_eq!(mark, Rect { left: 12, bottom: 32, right: 29, top: 49 });
    }
}
