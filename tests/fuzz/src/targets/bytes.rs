//! Decisions and numbers from bytes. Where there are no more, all are 0.

/// Numbers that arithmetic is seldom asked about.
const ODD: [f64; 20] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    f64::MIN_POSITIVE,
    5e-324,
    1e-40,
    1.5e308,
    -1.5e308,
    f64::MAX,
    f32::MAX as f64,
    -1e38,
    1e38,
    1e300,
    -1e300,
    16_777_216.0,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// The bytes that are left.
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl Bytes<'_> {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        first
    }

    pub(super) fn yes(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    /// A whole number below `count`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (usize::from(self.byte()) << 8 | usize::from(self.byte())) % count
    }

    pub(super) fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// A number in −4..4, mostly.
    pub(super) fn ordinary(&mut self) -> f64 {
        f64::from(i16::from_be_bytes([self.byte(), self.byte()])) / 8192.0
    }

    /// An ordinary number, an odd one, or any bits at all.
    pub(super) fn number(&mut self) -> f64 {
        match self.byte() {
            0..200 => self.ordinary(),
            200..250 => self.one_of(&ODD),
            _ => f64::from_bits(u64::from_be_bytes(std::array::from_fn(|_| self.byte()))),
        }
    }
}
