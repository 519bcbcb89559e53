//! What is fuzzed, for libFuzzer. The targets are plain functions of bytes; the project's own tests call them too.

use rasterbook::figure::Chapter;

mod arguments;
#[path = "../../../docs/live/src/chapters.rs"]
mod chapters;
mod targets;

/// All chapters, in the order of the book.
fn all() -> Vec<&'static Chapter> {
    chapters::CHAPTERS.iter().collect()
}

macro_rules! targets {
    ($($module:ident::$name:ident($($chapters:ident)?)),* $(,)?) => {
        $(
            /// The target of this name.
            pub fn $name(data: &[u8]) {
                $module::$name($(&$chapters(),)? data);
            }
        )*
    };
}

targets!(
    targets::model(),
    targets::image(),
    targets::scene(),
    targets::polygon(),
    targets::history(all),
    arguments::arguments(all),
);
