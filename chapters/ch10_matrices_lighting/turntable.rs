//! A model of your own, seen from anywhere: framed by its bounds, lit from the side, drawn from both sides.

use glam::{DMat4, DVec3};
use rasterbook::cull::CullMode;
use rasterbook::figure::{Canvas, Knob, Subject};
use rasterbook::light::{blinn_phong, lambert, normalize, scale, subtract};
use rasterbook::mipmap::MipMaps;
use rasterbook::model::ModelVertex;
use rasterbook::real::each;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, look_at};
use rasterbook::varyings::Derivatives;
use rasterbook::{ClipVertex, Color, Framebuffer, Real, Rect, RenderState, Shaded, Shader};

use super::degrees;
use super::directions::{direction, light_azimuth, light_elevation};

pub(super) const KNOBS: &[Knob] = &[
    Knob::number(
        "azimuth",
        35.0,
        [-180.0, 180.0],
        "°",
        "the eye goes round: a highlight moves over the surface, the dark side stays where it is",
    ),
    Knob::number("elevation", 25.0, [-89.0, 89.0], "°", "the eye goes up: the top comes into view"),
    light_azimuth(-30.0),
    light_elevation(50.0),
    Knob::number("exponent", 40.0, [1.0, 200.0], "", "the highlight becomes small and sharp"),
    Knob::choice(
        "shading",
        &["phong", "gouraud"],
        "light at each pixel, or at each vertex and interpolated: a highlight between vertices is lost",
    ),
    Knob::choice(
        "filter",
        &["trilinear", "bilinear", "nearest"],
        "trilinear has the right copy for a far face; nearest shows each near texel as a square",
    ),
    Knob::color(
        "background",
        Color::rgb(122, 130, 140),
        "dark and bright models both stand out from a middle gray",
    ),
];

/// The light of the lamp, and that of the surroundings: from above, and from the ground.
const LAMP: f64 = 0.95;
const SKY: f64 = 0.26;
const GROUND: f64 = 0.09;

// ANCHOR: eye
/// The camera that sees all of a sphere, and where it is.
fn camera(center: DVec3, radius: f64, towards: DVec3) -> (DMat4, DVec3) {
    const FIELD_OF_VIEW: f64 = 32.0;
    // A little farther away than needed, so that nothing touches the border.
    let distance = 1.06 * radius / libm::sin(degrees(FIELD_OF_VIEW / 2.0));
    let eye = center + distance * towards;
    let frustum = Frustum::from_field_of_view(
        degrees(FIELD_OF_VIEW),
        4.0 / 3.0,
        distance - 1.01 * radius,
        distance + 1.01 * radius,
    );
    (frustum.matrix() * look_at(eye, center, DVec3::Y), eye)
}
// ANCHOR_END: eye

/// A surface under a lamp and a sky.
#[derive(Clone, Copy)]
struct Surface<'a> {
    clip_from_model: DMat4,
    eye: DVec3,
    to_light: DVec3,
    /// 1 for the side that the normals point to, −1 for the other one.
    side: f64,
    exponent: f64,
    /// Light is computed at the vertices, and interpolated (Gouraud).
    lit_at_vertices: bool,
    filter: &'static str,
    texture: &'a Texture,
    maps: &'a MipMaps,
}

/// Varyings: the place, the normal (with light from the vertices, that light in its place), and texture coordinates.
impl Shader<8> for Surface<'_> {
    type Attributes = ModelVertex;
    const USES_DERIVATIVES: bool = true;

    fn vertex(&self, vertex: &ModelVertex) -> ClipVertex<8> {
        let ModelVertex { position: p, normal, uv: [u, v] } = *vertex;
        let [nx, ny, nz] = if self.lit_at_vertices {
            let [body, gloss] = self.light(p.to_array(), normal.to_array());
            [body, gloss, 0.0]
        } else {
            normal.to_array()
        };
        let position = self.clip_from_model * p.extend(1.0);
        ClipVertex { position, varyings: [p.x, p.y, p.z, nx, ny, nz, u, v] }
    }

    fn fragment<R: Real>(&self, [x, y, z, nx, ny, nz, u, v]: [R; 8]) -> Shaded<R> {
        self.shade([x, y, z], [nx, ny, nz], self.texture.bilinear([u, v], AddressMode::Repeat))
    }

    fn fragment_with_derivatives<R: Real>(
        &self,
        varyings: [R; 8],
        change: Derivatives<R, 8>,
    ) -> Shaded<R> {
        let [x, y, z, nx, ny, nz, u, v] = varyings;
        let texel = match self.filter {
            "nearest" => self.texture.nearest([u, v], AddressMode::Repeat),
            "bilinear" => self.texture.bilinear([u, v], AddressMode::Repeat),
            _ => {
                let (dx, dy) = ([change.dx[6], change.dx[7]], [change.dy[6], change.dy[7]]);
                self.maps.trilinear([u, v], self.maps.level_of_detail(dx, dy), AddressMode::Repeat)
            }
        };
        self.shade([x, y, z], [nx, ny, nz], texel)
    }
}

impl Surface<'_> {
    /// How much light a place sends to the eye: from the surface's own color, and as a highlight.
    fn light<R: Real>(&self, place: [R; 3], normal: [R; 3]) -> [R; 2] {
        let normal = normalize(scale(normal, R::of(self.side)));
        let to_light = R::array_of(self.to_light.to_array());
        let to_eye = normalize(subtract(R::array_of(self.eye.to_array()), place));
        let diffuse = lambert(normal, to_light) * R::of(LAMP);
        let gloss = blinn_phong(normal, to_light, to_eye, self.exponent) * R::of(0.18);
        // From the ground to the sky, as far as the normal points up.
        let up = normal[1] * R::of(0.5) + R::of(0.5);
        let around = up * R::of(SKY - GROUND) + R::of(GROUND);
        [diffuse + around, gloss]
    }

    /// The color of a texel under the light of a place; `normal` is the light itself where it comes from vertices.
    fn shade<R: Real>(&self, place: [R; 3], normal: [R; 3], texel: [R; 3]) -> Shaded<R> {
        let [body, gloss] =
            if self.lit_at_vertices { [normal[0], normal[1]] } else { self.light(place, normal) };
        // A square and a square root in place of the transfer function: nearly the same, and fast enough to be dragged.
        Shaded::opaque(each(texel, |_, channel| {
            let surface = channel * channel * R::of(1.0 / (255.0 * 255.0));
            (surface * body + gloss).min(R::of(1.0)).sqrt() * R::of(255.0)
        }))
    }
}

/// A gradient: the color in the middle, brighter above, darker below.
fn backdrop(picture: &mut Framebuffer, color: Color) {
    let rect = picture.rect();
    for y in rect.rows() {
        let brightness = 0.8 + 0.4 * f64::from(y) / f64::from(rect.top);
        let row = Color::truncated(color.to_f64().map(|channel| (channel * brightness).min(255.0)));
        picture.fill(Rect { bottom: y, top: y + 1, ..rect }, row);
    }
}

/// The model as on a turntable; the eye goes round it once in all frames.
pub(super) fn turntable(canvas: &mut Canvas, subject: &Subject) {
    let knobs = canvas.knobs.clone();
    let azimuth = knobs.number("azimuth") + 3.0 * f64::from(canvas.frame);
    let (exponent, filter) = (knobs.number("exponent"), knobs.choice("filter"));
    let lit_at_vertices = knobs.choice("shading") == "gouraud";
    let (center, radius) = subject.model.bounding_sphere();
    let towards = direction(azimuth, knobs.number("elevation"));
    let (clip_from_model, eye) = camera(center, radius, towards);
    let to_light = direction(knobs.number("light-azimuth"), knobs.number("light-elevation"));

    canvas.clear(&RenderState::default());
    backdrop(canvas.picture_mut(), knobs.color("background"));
    for part in subject.model.parts.iter() {
        let texture = &subject.texture_of(part);
        let maps = &MipMaps::new(texture);
        // Files from elsewhere do not always turn their fronts outwards: backs are drawn too, lit from their own side.
        // Fronts come first: what they hide is not shaded.
        for (cull, side) in [(CullMode::Back, 1.0), (CullMode::Front, -1.0)] {
            let surface = Surface {
                clip_from_model,
                eye,
                to_light,
                side,
                exponent,
                lit_at_vertices,
                filter,
                texture,
                maps,
            };
            canvas.draw(&part.mesh, &surface, &RenderState { cull, ..RenderState::default() });
        }
    }
}
