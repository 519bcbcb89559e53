//! Which variant is meant, and what is said where none is.

use super::arguments::{Comparison, Request};
use super::failure::Failure;
use super::programs::{PROGRAMS, Program};
use crate::figure::{Chapter, Knobs, Mistake, Variant};

/// The variant for those who have named none: the lead, or the first that can draw the model that was given, and
/// has the knobs that were set.
pub(super) fn unnamed<'a>(chapter: &'a Chapter, request: &Request) -> &'a Variant {
    let has_knobs = |variant: &Variant| {
        let knobs = Knobs::new(variant.knobs, variant.size);
        let names = request.settings.iter().filter_map(|setting| setting.split_once('='));
        names.map(|(name, _)| name).chain(request.sweep.as_deref()).all(|name| knobs.find(name).is_some())
    };
    let accepts =
        |variant: &&Variant| check_model_options(chapter, variant, request).is_ok() && has_knobs(variant);
    chapter.variants.iter().find(accepts).unwrap_or_else(|| chapter.lead())
}

/// For those who have named no variant: what is seen, what to compare it with, how to ask a pixel, and how to see it live.
pub(super) fn hints(chapter: &Chapter, drawn: &Variant) -> String {
    let Variant { name, look, size: (width, height), .. } = drawn;
    let run = format!("cargo run --bin {} --", chapter.name);
    let is_compared = |variant: &&Variant| matches!(variant.mistake, Mistake::RemediedBy(_));
    let compare = match chapter.variants.iter().find(is_compared) {
        Some(mistake) => format!("A mistake beside its remedy: {run} {} --compare", mistake.name),
        None => format!("What else can be drawn: {run} --list"),
    };
    let pixel = format!("{},{}", width / 2, height / 2);
    let live = format!("cargo run --features window --bin {} -- {name} --window", chapter.name);
    format!(
        "{name}: {look}\n{compare}\nWhat happened at a pixel: {run} {name} --inspect {pixel}\n\
         Live, to turn and to drag: {live}"
    )
}

pub(super) fn find<'a>(chapter: &'a Chapter, name: &str) -> Result<&'a Variant, Failure> {
    chapter.find(name).ok_or_else(|| Failure::Usage(no_such_variant(chapter, name)))
}

/// What is said of a name that no variant has: what may be meant, here or in another program, and what there is.
fn no_such_variant(chapter: &Chapter, name: &str) -> String {
    let names: Vec<&str> = chapter.variants.iter().map(|variant| variant.name).collect();
    let likeness = |known: &&str| strsim::jaro(name, known);
    let nearest = names.iter().copied().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let others: Vec<&str> = PROGRAMS
        .iter()
        .filter(|program| program.variants.contains(&name))
        .map(|program| program.name)
        .collect();
    let hint = match nearest.filter(|nearest| strsim::jaro(name, nearest) > 0.8) {
        _ if !others.is_empty() => format!("; {} has it", others.join(" and ")),
        Some(nearest) => format!("; did you mean '{nearest}'?"),
        None => String::new(),
    };
    format!("{} has no variant '{name}'{hint}\nIt has: {}", chapter.name, names.join(", "))
}

/// The variant to compare with.
pub(super) fn other<'a>(
    chapter: &'a Chapter,
    variant: &Variant,
    comparison: &Comparison,
) -> Result<&'a Variant, Failure> {
    match (comparison, variant.mistake) {
        (Comparison::With(name), _) => find(chapter, name),
        (Comparison::Remedy, Mistake::RemediedBy(remedy)) => find(chapter, remedy),
        (Comparison::Remedy, _) => Err(Failure::Usage(format!(
            "'{}' has no remedy to be compared with: name the other variant, --compare OTHER",
            variant.name
        ))),
    }
}

/// Whether what was given in place of a variant's own model and texture means anything to it.
pub(super) fn check_model_options(
    chapter: &Chapter,
    variant: &Variant,
    request: &Request,
) -> Result<(), Failure> {
    let name = variant.name;
    if !variant.has_model() && (request.model.is_some() || request.as_is || request.flat) {
        let others = those(chapter, Variant::has_model, |program| program.has_model);
        return Err(Failure::Usage(format!(
            "'{name}' draws no model: --model, --as-is and --flat mean nothing to it\nModels are drawn by {others}"
        )));
    }
    if variant.fits_model && request.as_is {
        return Err(Failure::Usage(format!(
            "'{}' brings every model into its view: --as-is means nothing to it",
            variant.name
        )));
    }
    if !variant.has_texture() && request.texture.is_some() {
        let others = those(chapter, Variant::has_texture, |program| program.has_texture);
        return Err(Failure::Usage(format!(
            "'{name}' draws no texture: --texture means nothing to it\nTextures are drawn by {others}"
        )));
    }
    Ok(())
}

/// The variants of a chapter that do something; if none does, the programs that do.
fn those(chapter: &Chapter, does: fn(&Variant) -> bool, has: fn(&Program) -> bool) -> String {
    let variants: Vec<&str> =
        chapter.variants.iter().filter(|variant| does(variant)).map(|variant| variant.name).collect();
    if !variants.is_empty() {
        return variants.join(", ");
    }
    let programs: Vec<&str> =
        PROGRAMS.iter().filter(|program| has(program)).map(|program| program.name).collect();
    format!("other programs: {}", programs.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::framebuffer::Framebuffer;

    fn nothing(_: &mut Framebuffer) {}

    #[test]
    fn hints_for_a_newcomer_and_for_a_wrong_name() {
        const RIGHT: Variant = Variant::new("right", nothing, "what is right").size(640, 480);
        const WRONG: Variant = Variant::new("wrong", nothing, "what is wrong").remedied_by("right");
        let with_mistake = Chapter { name: "ch00", question: "?", variants: &[RIGHT, WRONG] };
        assert_eq!(
            hints(&with_mistake, with_mistake.lead()),
            "right: what is right\n\
             A mistake beside its remedy: cargo run --bin ch00 -- wrong --compare\n\
             What happened at a pixel: cargo run --bin ch00 -- right --inspect 320,240\n\
             Live, to turn and to drag: cargo run --features window --bin ch00 -- right --window"
        );
        assert_eq!(
            no_such_variant(&with_mistake, "wring"),
            "ch00 has no variant 'wring'; did you mean 'wrong'?\nIt has: right, wrong"
        );
        assert_eq!(
            no_such_variant(&with_mistake, "camera"),
            "ch00 has no variant 'camera'; ch10_matrices_lighting has it\nIt has: right, wrong"
        );
        assert_eq!(no_such_variant(&with_mistake, "x"), "ch00 has no variant 'x'\nIt has: right, wrong");
        let without = Chapter { variants: &[RIGHT], ..with_mistake };
        assert!(
            hints(&without, without.lead())
                .contains("\nWhat else can be drawn: cargo run --bin ch00 -- --list\n")
        );
    }
}
