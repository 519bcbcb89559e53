//! Which instructions the fast rasterizer draws with: decided when a program runs.

use std::fmt::{self, Display};

#[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
use super::avx2::{Avx2, avx2};
use super::baseline::Baseline;

/// Which instructions a [`Tiled`](super::Tiled) draws with. The picture is the same to the last bit, the time is not.
///
/// ```
/// use rasterbook::tiled::{Instructions, Tiled};
///
/// let best = Tiled::new().instructions();
/// assert_eq!(best.to_string(), Instructions::available().last().unwrap().to_string());
/// let slow = Tiled::new().with_instructions(Instructions::baseline());
/// println!("{best} or {}", slow.instructions()); // such as: avx2 or sse2
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Instructions(pub(super) Compiled);

/// The copies that there are of the code, each with the proof that the processor has its instructions.
#[derive(Clone, Copy, Debug)]
pub(super) enum Compiled {
    Baseline(Baseline),
    #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
    Avx2(Avx2),
}

impl Instructions {
    /// Those that the whole program is compiled for.
    #[must_use]
    pub const fn baseline() -> Self {
        Self(Compiled::Baseline(Baseline))
    }

    /// Those that this processor has, the best last.
    pub fn available() -> impl Iterator<Item = Self> {
        #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
        let more = avx2().map(Compiled::Avx2);
        #[cfg(not(all(target_arch = "x86_64", not(target_feature = "avx2"))))]
        let more = None;
        std::iter::once(Self::baseline()).chain(more.map(Self))
    }
}

impl Default for Instructions {
    /// The best that this processor has.
    fn default() -> Self {
        Self::available().last().unwrap_or(Self::baseline())
    }
}

impl Display for Instructions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            Compiled::Baseline(_) => BASELINE_NAME,
            #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
            Compiled::Avx2(_) => "avx2",
        })
    }
}

/// The instructions for lanes that the whole program is compiled for.
const BASELINE_NAME: &str = if cfg!(target_feature = "avx512f") {
    "avx512"
} else if cfg!(target_feature = "avx2") {
    "avx2"
} else if cfg!(target_feature = "avx") {
    "avx"
} else if cfg!(target_feature = "sse4.1") {
    "sse4"
} else if cfg!(target_feature = "sse2") {
    "sse2"
} else if cfg!(target_feature = "neon") {
    "neon"
} else if cfg!(target_feature = "simd128") {
    "simd128"
} else {
    "none"
};

/// Does something with each set of instructions that this processor has.
#[cfg(test)]
macro_rules! with_each {
    ($instructions:ident => $work:block) => {
        for instructions in $crate::tiled::Instructions::available() {
            match instructions.0 {
                $crate::tiled::instructions::Compiled::Baseline($instructions) => $work,
                #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
                $crate::tiled::instructions::Compiled::Avx2($instructions) => $work,
            }
        }
    };
}
#[cfg(test)]
pub(super) use with_each;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiled::Tiled;

    #[test]
    #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
    fn avx2_is_found() {
        // The crate wants more than that, which all processors with AVX2 have but for a few emulated ones.
        let has_avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi2");
        let is_complete = is_x86_feature_detected!("fma") && is_x86_feature_detected!("movbe");
        if has_avx2 && is_complete {
            assert_eq!(Instructions::available().count(), 2);
        }
    }

    #[test]
    fn each_has_a_name_and_the_best_is_taken() {
        let names: Vec<String> = Instructions::available().map(|it| it.to_string()).collect();
        assert_eq!(names[0], Instructions::baseline().to_string());
        assert_eq!(names.last(), Some(&Tiled::new().instructions().to_string()));
        assert!(names.len() < 2 || names[1] == "avx2" && names[0] != "avx2", "{names:?}");
        let slow = Tiled::new().with_instructions(Instructions::baseline());
        assert_eq!(slow.instructions().to_string(), names[0]);
    }
}
