//! Beside the data flow: a value for each pixel of a picture, in memory. Colors and depths are kept in such planes.
//!
//! It reads as a slice. A stage that writes many pixels at a time can leave a memo with it, which is kept until a value
//! changes: what is known of the values need not be found out again.

use std::ops::{Deref, DerefMut};

/// How many values a plane of these sides has, with so many for each pixel; `None` if no memory can hold them.
pub(crate) fn count_of<T>([width, height]: [u32; 2], values: usize) -> Option<usize> {
    let count = (u128::from(width) * u128::from(height)).checked_mul(values as u128)?;
    let most = isize::MAX as u128 / size_of::<T>() as u128;
    (count <= most).then_some(count as usize)
}

/// The values of a picture, row by row from below, each from left to right.
#[derive(Debug)]
pub(crate) struct PixelPlane<T> {
    values: Vec<T>,
    #[cfg(feature = "tiled")]
    memo: Memo,
}

/// What is known of the values of a plane.
#[cfg(feature = "tiled")]
#[derive(Debug, Default)]
struct Memo {
    value: Option<Box<dyn std::any::Any + Send + Sync>>,
    /// Whether no value has changed since. A write clears this flag, and does no more.
    is_valid: bool,
}

#[cfg(feature = "tiled")]
impl Memo {
    #[inline]
    const fn forget(&mut self) {
        self.is_valid = false;
    }
}

impl<T> From<Vec<T>> for PixelPlane<T> {
    fn from(values: Vec<T>) -> Self {
        Self {
            values,
            #[cfg(feature = "tiled")]
            memo: Memo::default(),
        }
    }
}

/// The same values, without a memo.
impl<T: Clone> Clone for PixelPlane<T> {
    fn clone(&self) -> Self {
        self.values.clone().into()
    }
}

impl<T> Deref for PixelPlane<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &self.values
    }
}

impl<T> DerefMut for PixelPlane<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        #[cfg(feature = "tiled")]
        self.memo.forget();
        &mut self.values
    }
}

#[cfg(feature = "tiled")]
impl<T> PixelPlane<T> {
    /// Takes the memo out, if one of this type was left and no value has changed since.
    pub(crate) fn take_memo<M: 'static>(&mut self) -> Option<Box<M>> {
        let Memo { value, is_valid } = std::mem::take(&mut self.memo);
        value.filter(|_| is_valid)?.downcast().ok()
    }

    /// Leaves a memo about the values as they are now.
    pub(crate) fn leave_memo<M: Send + Sync + 'static>(&mut self, memo: Box<M>) {
        self.memo = Memo { value: Some(memo), is_valid: true };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_counted_as_far_as_memory_goes() {
        const SIDE: u32 = 1 << 16;
        assert_eq!(count_of::<u8>([3, 2], 5), Some(30));
        assert_eq!([[0, u32::MAX], [u32::MAX, 0]].map(|sides| count_of::<f64>(sides, 1)), [Some(0); 2]);
        // Just so many, or one more; with 32 bits these sides would be multiplied to 0.
        let most = isize::MAX as usize / 8;
        assert_eq!([most, most + 1].map(|values| count_of::<f64>([1, 1], values)), [Some(most), None]);
        assert_eq!(count_of::<f64>([SIDE, SIDE], 1).is_some(), usize::BITS > 32);
        assert_eq!(count_of::<u8>([u32::MAX; 2], usize::MAX), None);
    }

    #[cfg(feature = "tiled")]
    #[test]
    fn a_memo_is_kept_until_a_value_changes() {
        let mut plane = PixelPlane::from(vec![1, 2, 3]);
        plane.leave_memo(Box::new("rising"));
        assert_eq!(plane[1], 2);
        assert_eq!(plane.clone().take_memo::<&str>(), None, "a copy has none");
        assert_eq!(plane.take_memo::<&str>().as_deref(), Some(&"rising"));
        plane.leave_memo(Box::new("rising"));
        plane[1] = 9;
        assert_eq!(plane.take_memo::<&str>(), None);
    }
}
