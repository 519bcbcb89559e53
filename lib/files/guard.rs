//! Decoders of others. Where one panics, the file is refused, as with any other error of theirs.
//!
//! Known of those used here: PNG files whose palette is no whole number of colors, or has more than 256 (`png` 0.17), and some
//! damaged JPEG files (`zune-jpeg` 0.5.15).

use std::any::Any;
use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::sync::Once;

use super::FileError;

thread_local! {
    /// Whether a decoder is at work in this thread.
    static DECODES: Cell<bool> = const { Cell::new(false) };
}

/// What `decode` answers; if it panics, an error with the panic's message. (Where a panic ends the program, it does so here,
/// too: with `panic = "abort"`, and in WebAssembly.)
pub(super) fn guarded<T>(path: &Path, decode: impl FnOnce() -> Result<T, FileError>) -> Result<T, FileError> {
    DECODES.set(true);
    // A decoder that has panicked is gone, and so is what it has changed.
    let decoded = panic::catch_unwind(AssertUnwindSafe(decode));
    DECODES.set(false);
    decoded.unwrap_or_else(|panic| {
        Err(FileError::new(path, format!("its decoder failed: {}", message(panic.as_ref()))))
    })
}

/// What a panic says.
fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref().copied()).unwrap_or("it does not say why")
}

/// Lets nothing be printed where the decoder of an image panics, from now on: the file is refused, and the error says why.
///
/// A hook of all the program, [`panic::set_hook`]; other panics are told as before. The chapters' programs call it.
pub fn silence_decoders() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !DECODES.get() {
                before(panic);
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(panic = "unwind")]
    fn a_panic_is_an_error_that_names_the_file() {
        let refused = |decode: fn() -> Result<u8, FileError>| {
            let refused = guarded("a.png".as_ref(), decode).expect_err("it panics").to_string();
            assert!(!DECODES.get(), "it is over");
            refused
        };
        let at = |index: usize| [1, 2, 3][index];
        assert_eq!(guarded("a.png".as_ref(), || Ok(at(2))).ok(), Some(3));
        assert_eq!(refused(|| panic!("no palette")), "a.png: its decoder failed: no palette");
        assert_eq!(refused(|| panic!("{} colors", 257)), "a.png: its decoder failed: 257 colors");
        assert_eq!(refused(|| panic::panic_any(7)), "a.png: its decoder failed: it does not say why");
        let error = || Err(FileError::new("a.png".as_ref(), "is damaged"));
        assert_eq!(refused(error), "a.png: is damaged");
    }
}
