//! What is to be drawn, from what was asked for: the scene, and the files that it is made of.

use std::path::Path;

use glam::DVec3;

use super::animation::progress_bar;
use super::arguments::Request;
use super::failure::Failure;
use super::lists::knob_list;
use super::options::SHORT;
use super::output::note;
use crate::color::Color;
use crate::figure::picture::{Zoom, width_side_by_side};
use crate::figure::{DrawOptions, Given, Knob, KnobError, RasterizerChoice, Scene, Subject, Variant};
use crate::files::{FileError, load_texture, shown_path};
use crate::framebuffer::Framebuffer;
use crate::model::Model;
use crate::rect::{Pixel, Rect};
use crate::texture::Texture;

/// A variant as it was asked for: what it is a picture of, its size, its rasterizer, its knobs, its frame.
pub(super) fn scene_of<'a>(
    variant: &'a Variant,
    request: &Request,
    given: &Given,
) -> Result<Scene<'a>, Failure> {
    let mut scene = Scene { frame: frame_of(variant, request)?, ..sized(variant, request, given)? };
    for setting in &request.settings {
        scene.knobs.set(setting).map_err(|error| not_set(variant, &error))?;
    }
    Ok(scene)
}

/// The same at the first frame, its knobs at their defaults.
fn sized<'a>(variant: &'a Variant, request: &Request, given: &Given) -> Result<Scene<'a>, Failure> {
    let size = request.size.unwrap_or(variant.size);
    check_zoom(size, request.zoom)?;
    if variant.in_pixels && size != variant.size {
        let name = variant.name;
        note(&format!("'{name}' is drawn in pixels: the size only crops it or leaves a border black"));
    }
    let rasterizer = rasterizer_of(variant, request)?;
    Ok(Scene { size, rasterizer, ..Scene::new(variant, given).map_err(runtime_failure)? })
}

/// Two variants that are to be compared: the second takes over the frame, and the knobs that it has too. What cannot lie side
/// by side is refused before it is drawn; an enlarged part always can.
pub(super) fn pair_of<'a>(
    this: &'a Variant,
    that: &'a Variant,
    request: &Request,
) -> Result<(Scene<'a>, Scene<'a>), Failure> {
    let given = load(request)?;
    let first = scene_of(this, request, &given)?;
    let mut second = Scene { frame: first.frame, ..sized(that, request, &given)? };
    second.knobs.take_over(&first.knobs);
    let is_enlarged = request.zoom.is_some_and(|zoom| zoom.factor > 1);
    let fits = is_enlarged || width_side_by_side([first.size.0; 3]).is_some();
    if first.size == second.size && fits { Ok((first, second)) } else { Err(not_comparable(&first, &second)) }
}

/// Why two variants cannot be drawn side by side.
fn not_comparable(first: &Scene<'_>, second: &Scene<'_>) -> Failure {
    Failure::Usage(if first.size == second.size {
        "three such pictures are too wide: give a smaller --size".to_owned()
    } else {
        format!("'{}' and '{}' differ in size: give --size", first.variant.name, second.variant.name)
    })
}

/// Reads what was given in place of a variant's own model and texture.
pub(super) fn load(request: &Request) -> Result<Given, Failure> {
    let mut warnings = Vec::new();
    let mut model = None;
    if let Some(path) = &request.model {
        let progress = progress_bar(0, "bytes");
        let loaded = Model::load(path, request.normal_style(), |read, total| {
            progress.set_length(total);
            progress.set_position(read);
        });
        progress.finish_and_clear();
        let (loaded, more) = loaded.map_err(runtime_failure)?;
        warnings.extend(more);
        if request.texture.is_some() && !loaded.has_texture_coordinates() {
            let odd = "has no texture coordinates: one texel covers all of it";
            warnings.push(format!("{}: {odd}", shown_path(path)));
        }
        model = Some(if request.as_is { loaded } else { loaded.fitted(PLACE.0, PLACE.1) });
    }
    let mut texture = None;
    if let Some(path) = &request.texture {
        let (loaded, more) = load_texture(path).map_err(runtime_failure)?;
        warnings.extend(more);
        texture = Some(loaded);
    }
    for warning in warnings {
        note(&format!("warning: {warning}"));
    }
    Ok(Given { model, texture, style: request.normal_style() })
}

/// Where a model is brought to, and how far it reaches from there; the near plane of the book's view is at z = 2.
const PLACE: (DVec3, f64) = (DVec3::new(0.0, 0.0, 4.0), 1.7);

/// The frame that was asked for, if the variant has it.
fn frame_of(variant: &Variant, request: &Request) -> Result<u32, Failure> {
    match (request.frame, variant.animation) {
        (None, _) => Ok(0),
        (Some(_), None) => {
            Err(Failure::Usage(format!("'{}' is one picture: it has no frames", variant.name)))
        }
        (Some(frame), Some(animation)) if frame < animation.frames => Ok(frame),
        (Some(frame), Some(animation)) => Err(Failure::Usage(format!(
            "'{}' has no frame {frame}: its frames are 0 to {}",
            variant.name,
            animation.frames - 1
        ))),
    }
}

/// The rasterizer that was asked for, if the variant has a choice.
fn rasterizer_of(variant: &Variant, request: &Request) -> Result<RasterizerChoice, Failure> {
    match (variant.rasterizer, request.rasterizer) {
        (None, Some(_)) => Err(Failure::Usage(format!(
            "'{}' does not use the pipeline: --rasterizer means nothing to it",
            variant.name
        ))),
        (own, asked) => Ok(asked.or(own).unwrap_or_default()),
    }
}

/// Why a knob was not set, and which there are.
fn not_set(variant: &Variant, error: &KnobError) -> Failure {
    // Who gave one of the short options has not named a knob.
    let sets = |name: &String| SHORT.iter().find(|(_, knobs)| knobs.contains(&name.as_str()));
    let short = match error {
        KnobError::Unknown(name) => {
            sets(name).map_or_else(String::new, |(option, _)| format!(" (--{option} sets it)"))
        }
        _ => String::new(),
    };
    Failure::Usage(format!("'{}': {error}{short}\n{}", variant.name, knob_list(variant)))
}

/// The knob of a name that is to be swept, if it has a range and is not set too.
pub(super) fn sweepable(variant: &Variant, name: &str, request: &Request) -> Result<&'static Knob, Failure> {
    let knob = variant.knobs.iter().find(|knob| knob.name == name);
    let knob = knob.ok_or_else(|| not_set(variant, &KnobError::Unknown(name.to_owned())))?;
    if knob.at(0.0).is_none() {
        return Err(Failure::Usage(format!("'{name}' is {}: it has no range to be swept", knob.range())));
    }
    let is_set = |setting: &String| setting.split_once('=').is_some_and(|(set, _)| set == name);
    if request.settings.iter().any(is_set) {
        return Err(Failure::Usage(format!("'{name}' is swept: it cannot be set too")));
    }
    Ok(knob)
}

/// What is wrong with a file.
pub(super) fn runtime_failure(error: FileError) -> Failure {
    Failure::Runtime(error.to_string())
}

/// Whether the pixel around which to zoom is in the picture.
fn check_zoom(size: (u32, u32), zoom: Option<Zoom>) -> Result<(), Failure> {
    zoom.and_then(|zoom| zoom.center).map_or(Ok(()), |pixel| check_inside(size, pixel))
}

pub(super) fn check_inside((width, height): (u32, u32), (x, y): Pixel) -> Result<(), Failure> {
    if Rect::sized(width, height).contains(x, y) {
        return Ok(());
    }
    Err(Failure::Usage(format!("the pixel {x},{y} is outside the picture of {width}×{height} pixels")))
}

/// If the picture shows nothing of the model: that it does not, and why.
pub(super) fn unseen(path: &Path, scene: &Scene<'_>, picture: &Framebuffer) -> Option<String> {
    let subject = scene.subject.as_ref()?;
    let drawn = |model: Model| {
        // White, so that what is as dark as the background counts as seen.
        let texture = Some(Texture::new(1, 1, vec![Color::WHITE]));
        scene.variant.draw(&DrawOptions { subject: Some(&Subject { model, texture }), ..scene.options(None) })
    };
    let empty = drawn(Model { parts: [].into() });
    if *picture != empty || drawn(subject.model.clone()) != empty {
        return None;
    }
    let meshes = || subject.model.parts.iter().map(|part| &part.mesh);
    let has_area = meshes().any(|mesh| {
        mesh.triangles().any(|indices| {
            let [a, b, c] = indices.map(|index| mesh.vertices()[index].position);
            (b - a).cross(c - a) != DVec3::ZERO
        })
    });
    let reason = match (has_area, scene.variant.fits_model) {
        (false, _) => "its faces have no area",
        // It is drawn whole, from both sides: so from its edge.
        (true, true) => "its faces are seen from their edge",
        (true, false) => "its faces turn away from the eye, or lie outside the view",
    };
    Some(format!("nothing of {} is visible: {reason}", shown_path(path)))
}

/// The file name of a picture as it was asked for, without extension.
pub(super) fn name_of(scene: &Scene<'_>, request: &Request) -> String {
    picture_name(scene, request.frame, request.rasterizer, request.zoom)
}

/// The file name of a scene's picture, without extension: what is not as in the table stands in it.
pub(super) fn picture_name(
    scene: &Scene<'_>,
    frame: Option<u32>,
    rasterizer: Option<RasterizerChoice>,
    zoom: Option<Zoom>,
) -> String {
    let frame = frame.map_or_else(String::new, |frame| format!("@{frame:03}"));
    let rasterizer = rasterizer.map_or_else(String::new, |choice| format!("-{}", choice.name()));
    let zoom = zoom.map_or_else(String::new, |zoom| {
        let place = zoom.center.map_or_else(String::new, |(x, y)| format!("-at-{x}-{y}"));
        format!("-zoom{}{place}", zoom.factor)
    });
    let knobs: String = scene.knobs.changed().iter().map(|knob| format!("-{knob}")).collect();
    let knobs = knobs.replace(['=', ','], "-");
    format!("{}{frame}{knobs}{rasterizer}{zoom}", scene.variant.name)
}
