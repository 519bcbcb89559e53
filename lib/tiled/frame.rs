//! What all tiles of a picture share.

use std::sync::atomic::{AtomicBool, Ordering};

use super::front::{Front, Source};
use crate::interpolate::Interpolation;
use crate::merge::Merge;
use crate::shader::Shader;
use crate::state::RenderState;

/// What all tiles of a picture share.
pub(super) struct Frame<'a, S: Shader<N>, const N: usize> {
    pub(super) shader: &'a S,
    pub(super) state: &'a RenderState,
    pub(super) front: &'a Front,
    pub(super) source: &'a Source<'a, S, N>,
    /// Whether all options that matter for a pixel have their default values: the most common case.
    pub(super) is_plain: bool,
    /// How wide the picture is.
    pub(super) columns: i32,
    /// Whether the shader has been seen to throw fragments of larger triangles away: only these can hide others.
    pub(super) discards: AtomicBool,
}

impl<S: Shader<N>, const N: usize> Frame<'_, S, N> {
    /// Notes whether the shader has thrown away any.
    pub(super) fn note(&self, thrown_away: i32) {
        if thrown_away != 0 {
            self.discards.store(true, Ordering::Relaxed);
        }
    }
}

/// Whether these options for a pixel are the default ones.
pub(super) fn is_plain(state: &RenderState) -> bool {
    state.merge == Merge::default()
        && state.depth_encoding.is_linear_on_screen()
        && state.interpolation == Interpolation::PerspectiveCorrect
}
