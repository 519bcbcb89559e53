//! What a chapter's program lists: its variants, and the knobs of one.

use crate::figure::{Animation, Chapter, Knob, Mistake, RasterizerChoice, Variant};
use crate::inspect::text_json;

/// Variants, a line each: name, then what to look for.
pub(super) fn list(variants: &[Variant]) -> String {
    let width = variants.iter().map(|variant| variant.name.len()).max().unwrap_or(0);
    let line = |variant: &Variant| {
        let mistake = match variant.mistake {
            Mistake::No => String::new(),
            Mistake::RemediedBy(remedy) => format!(" [mistake; remedy: {remedy}]"),
            Mistake::WithoutRemedy => " [mistake]".to_owned(),
        };
        let source = if variant.source.is_empty() { String::new() } else { format!(" ({})", variant.source) };
        let in_pixels = if variant.in_pixels { " [in pixels: --size does not scale it]" } else { "" };
        format!("  {:width$}  {}{source}{mistake}{in_pixels}\n", variant.name, variant.look)
    };
    variants.iter().map(line).collect()
}

/// The knobs of a variant, two lines each.
pub(super) fn knob_list(variant: &Variant) -> String {
    if variant.knobs.is_empty() {
        return format!("'{}' has no knobs", variant.name);
    }
    let line = |knob: &Knob| {
        let Knob { name, watch, .. } = knob;
        format!("\n  {name} = {}   ({})\n      {watch}", knob.shown(knob.default()), knob.range())
    };
    let lines: String = variant.knobs.iter().map(line).collect();
    format!("Knobs of '{}', --set NAME=VALUE:{lines}", variant.name)
}

/// The variants of a chapter as JSON, a line each, with all that the chapter's table says of them.
pub(super) fn list_json(chapter: &Chapter, variants: &[Variant]) -> String {
    let lines: Vec<String> =
        variants.iter().map(|variant| format!("\n    {}", variant_json(variant))).collect();
    format!(
        "{{\n  \"program\": {},\n  \"question\": {},\n  \"variants\": [{}\n  ]\n}}",
        text_json(chapter.name),
        text_json(chapter.question),
        lines.join(","),
    )
}

fn variant_json(variant: &Variant) -> String {
    const NONE: &str = "null";
    let text = |text: Option<&str>| text.map_or_else(|| NONE.to_owned(), text_json);
    let remedy = match variant.mistake {
        Mistake::RemediedBy(remedy) => Some(remedy),
        Mistake::No | Mistake::WithoutRemedy => None,
    };
    let animation = |Animation { frames, rate }| format!("{{\"frames\": {frames}, \"rate\": {rate}}}");
    let fields = [
        ("name", text_json(variant.name)),
        ("look", text_json(variant.look)),
        ("source", text((!variant.source.is_empty()).then_some(variant.source))),
        ("size", format!("[{}, {}]", variant.size.0, variant.size.1)),
        ("scales", (!variant.in_pixels).to_string()),
        ("mistake", (variant.mistake != Mistake::No).to_string()),
        ("remedy", text(remedy)),
        ("animation", variant.animation.map_or_else(|| NONE.to_owned(), animation)),
        ("rasterizer", text(variant.rasterizer.map(RasterizerChoice::name))),
        ("model", variant.has_model().to_string()),
        ("texture", variant.has_texture().to_string()),
        ("knobs", format!("[{}]", variant.knobs.iter().map(knob_json).collect::<Vec<_>>().join(", "))),
    ];
    object(&fields)
}

fn knob_json(knob: &Knob) -> String {
    object(&[
        ("name", text_json(knob.name)),
        ("default", text_json(&knob.shown(knob.default()))),
        ("range", text_json(&knob.range())),
        ("watch", text_json(knob.watch)),
    ])
}

/// An object of fields whose values are JSON already.
fn object(fields: &[(&str, String)]) -> String {
    let fields: Vec<String> =
        fields.iter().map(|(name, value)| format!("{}: {value}", text_json(name))).collect();
    format!("{{{}}}", fields.join(", "))
}
