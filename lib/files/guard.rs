//! Decoders of others. Where one panics, the file is refused, as with any other error of theirs.
//!
//! Known of those used here: PNG files whose palette is no whole number of colors, or has more than 256
//! ([`png` 0.17](https://github.com/image-rs/image-png/issues/694)), and some damaged JPEG files ([`zune-jpeg`
//! 0.5.15](https://github.com/etemesi254/zune-image/issues/409)).

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

/// What a decoder answers; if it panics, an error with the panic's message. For calls of decoders alone: what is wrong with
/// our own code must be seen.
pub(super) fn guarded<T>(path: &Path, decode: impl FnOnce() -> Result<T, FileError>) -> Result<T, FileError> {
    let outer = DECODES.replace(true);
    // A decoder that has panicked is not used again: the caller has an error in place of it.
    let decoded = panic::catch_unwind(AssertUnwindSafe(decode));
    DECODES.set(outer);
    decoded.unwrap_or_else(|payload| {
        Err(FileError::new(path, format!("its decoder failed: {}", message(payload.as_ref()))))
    })
}

/// What a panic says.
fn message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| payload.downcast_ref().copied()).unwrap_or("it does not say why")
}

/// Prints nothing where the decoder of an image panics: the file is refused, and the error says why. Other panics are told as
/// before. Where a panic ends the program, with `panic = "abort"`, this does nothing.
///
/// It wraps the hook that the program has for panics ([`panic::set_hook`]): call it once, at the start. The chapters'
/// programs do.
///
/// # Panics
/// If this thread is panicking.
pub fn silence_decoders() {
    static ONCE: Once = Once::new();
    if cfg!(panic = "unwind") {
        ONCE.call_once(|| panic::set_hook(without_decoders(panic::take_hook())));
    }
}

/// What is told of panics.
type Hook = Box<dyn Fn(&panic::PanicHookInfo<'_>) + Send + Sync>;

/// The same, but nothing of decoders.
fn without_decoders(hook: Hook) -> Hook {
    Box::new(move |info| {
        if !DECODES.get() {
            hook(info);
        }
    })
}

#[cfg(all(test, panic = "unwind"))]
mod tests {
    use super::*;

    fn refused(decode: impl FnOnce() -> Result<(), FileError>) -> String {
        guarded("a.png".as_ref(), decode).expect_err("it is refused").to_string()
    }

    #[test]
    fn a_panic_is_an_error_that_names_the_file() {
        assert_eq!(guarded("a.png".as_ref(), || Ok(3)).ok(), Some(3));
        assert_eq!(refused(|| panic!("no palette")), "a.png: its decoder failed: no palette");
        assert_eq!(refused(|| panic!("{} colors", 257)), "a.png: its decoder failed: 257 colors");
        assert_eq!(refused(|| panic::panic_any(7)), "a.png: its decoder failed: it does not say why");
        assert_eq!(refused(|| Err(FileError::new("a.png".as_ref(), "is damaged"))), "a.png: is damaged");
    }

    #[test]
    fn only_panics_of_decoders_are_silent() {
        thread_local! { static TOLD: Cell<u32> = const { Cell::new(0) }; }
        // Other threads run other tests: what they tell goes on as before.
        let before = panic::take_hook();
        let counting: Hook = Box::new(move |info| {
            TOLD.set(TOLD.get() + 1);
            before(info);
        });
        panic::set_hook(without_decoders(counting));
        let told = |panics: &dyn Fn()| {
            TOLD.set(0);
            assert!(panic::catch_unwind(AssertUnwindSafe(panics)).is_err());
            TOLD.get()
        };
        assert_eq!(told(&|| panic!("ours")), 1);
        let both = || {
            refused(|| panic!("theirs"));
            panic!("ours, later");
        };
        assert_eq!(told(&both), 1);
        let nested = || {
            refused(|| {
                refused(|| panic!("theirs"));
                panic!("theirs, too");
            });
            panic!("ours, later");
        };
        assert_eq!(told(&nested), 1);
    }
}
