//! Knobs: named values that a picture depends on, which a reader can turn.
//!
//! A chapter's table names them beside the variant; the drawing function reads them by name. Their defaults give the
//! pinned picture.
//!
//! ```
//! use rasterbook::figure::{Knob, Knobs};
//!
//! const TILT: Knob = Knob::number("tilt", 30.0, [0.0, 80.0], "°", "the break grows with the tilt");
//! let mut knobs = Knobs::new(&[TILT], (640, 480));
//! assert_eq!(knobs.number("tilt"), 30.0);
//! knobs.set("tilt=60").expect("in range");
//! assert_eq!(knobs.number("tilt"), 60.0);
//! assert!(knobs.set("tilt=81").is_err());
//! ```

use std::fmt;

use glam::DVec2;

use crate::color::Color;

use super::knob::{Kind, Knob, Value};

/// Why a knob was not set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KnobError {
    /// The text is not NAME=VALUE.
    Form(String),
    /// There is no knob of this name.
    Unknown(String),
    /// The value is not one that the knob can have.
    Value {
        /// The name of the knob.
        name: &'static str,
        /// What was given.
        text: String,
        /// What it can be.
        range: String,
    },
}

impl fmt::Display for KnobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form(text) => write!(f, "expected NAME=VALUE, not '{text}'"),
            Self::Unknown(name) => write!(f, "there is no knob '{name}'"),
            Self::Value { name, text, range } => write!(f, "'{name}' cannot be '{text}': it is {range}"),
        }
    }
}

impl std::error::Error for KnobError {}

/// The knobs of a variant and what they are set to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Knobs {
    knobs: &'static [Knob],
    values: Vec<Value>,
    size: (u32, u32),
}

impl Knobs {
    /// Knobs at their defaults, of a picture whose own size is `size`.
    #[must_use]
    pub fn new(knobs: &'static [Knob], size: (u32, u32)) -> Self {
        Self { knobs, values: knobs.iter().map(Knob::default).collect(), size }
    }

    /// The knobs and their values, in the order of the table.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&'static Knob, Value)> + '_ {
        self.knobs.iter().zip(self.values.iter().copied())
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.knobs.is_empty()
    }

    /// The knob of a name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&'static Knob> {
        self.knobs.iter().find(|knob| knob.name == name)
    }

    /// Sets the knob that a text NAME=VALUE names.
    ///
    /// # Errors
    /// If the text has another form, no knob has this name, or its range does not hold the value.
    pub fn set(&mut self, text: &str) -> Result<(), KnobError> {
        let (index, value) = self.read(text)?;
        self.values[index] = value;
        Ok(())
    }

    /// Which knob a text NAME=VALUE names, by its place in the table, and the value.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn read(&self, text: &str) -> Result<(usize, Value), KnobError> {
        let (name, value) = text.split_once('=').ok_or_else(|| KnobError::Form(text.to_owned()))?;
        let index = self.knobs.iter().position(|knob| knob.name == name);
        let index = index.ok_or_else(|| KnobError::Unknown(name.to_owned()))?;
        let knob = &self.knobs[index];
        let parsed = knob.parse(value, self.size).ok_or_else(|| KnobError::Value {
            name: knob.name,
            text: value.to_owned(),
            range: knob.range(),
        })?;
        Ok((index, parsed))
    }

    /// Sets a knob to a value, which is brought into its range, a point into the picture. Does nothing if no knob has this
    /// name, if the value is of another kind, or if it is no number.
    pub fn put(&mut self, name: &str, value: Value) {
        if let Some(index) = self.knobs.iter().position(|knob| knob.name == name)
            && let Some(value) = self.knobs[index].clamped(value, self.size)
        {
            self.values[index] = value;
        }
    }

    /// Takes over the values of those knobs that `other` has too.
    pub fn take_over(&mut self, other: &Self) {
        for (knob, value) in other.iter() {
            if self.find(knob.name).is_some_and(|own| own.kind == knob.kind) {
                self.put(knob.name, value);
            }
        }
    }

    /// Those that do not stand at their defaults, as NAME=VALUE.
    #[must_use]
    pub fn changed(&self) -> Vec<String> {
        let changed = self.iter().filter(|(knob, value)| *value != knob.default());
        changed.map(|(knob, value)| format!("{}={}", knob.name, knob.shown(value))).collect()
    }

    fn value(&self, name: &str) -> Value {
        let index = self.knobs.iter().position(|knob| knob.name == name);
        self.values[index.unwrap_or_else(|| panic!("the table has no knob '{name}'"))]
    }

    /// The number of a knob.
    ///
    /// # Panics
    /// If the table has no such number; that is a fault of the chapter. So do all that follow.
    #[must_use]
    pub fn number(&self, name: &str) -> f64 {
        match self.value(name) {
            Value::Number(value) => value,
            other => panic!("'{name}' is no number but {other:?}"),
        }
    }

    /// The whole number of a knob.
    ///
    /// # Panics
    /// As [`Self::number`].
    #[must_use]
    pub fn whole(&self, name: &str) -> i32 {
        match self.value(name) {
            Value::Whole(value) => value,
            other => panic!("'{name}' is no whole number but {other:?}"),
        }
    }

    /// The name that a knob stands at.
    ///
    /// # Panics
    /// As [`Self::number`].
    #[must_use]
    pub fn choice(&self, name: &str) -> &'static str {
        match (self.find(name).map(|knob| knob.kind), self.value(name)) {
            (Some(Kind::Choice(names)), Value::Choice(index)) => names[index],
            (_, other) => panic!("'{name}' is no choice but {other:?}"),
        }
    }

    /// Whether a switch is on.
    ///
    /// # Panics
    /// As [`Self::number`].
    #[must_use]
    pub fn is_on(&self, name: &str) -> bool {
        match self.value(name) {
            Value::Switch(on) => on,
            other => panic!("'{name}' is no switch but {other:?}"),
        }
    }

    /// The point of a knob, pixels of the variant's own size, y up.
    ///
    /// # Panics
    /// As [`Self::number`].
    #[must_use]
    pub fn point(&self, name: &str) -> DVec2 {
        match self.value(name) {
            Value::Point(point) => point,
            other => panic!("'{name}' is no point but {other:?}"),
        }
    }

    /// The color of a knob.
    ///
    /// # Panics
    /// As [`Self::number`].
    #[must_use]
    pub fn color(&self, name: &str) -> Color {
        match self.value(name) {
            Value::Color(color) => color,
            other => panic!("'{name}' is no color but {other:?}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::super::knob::tests::KNOBS;
    use super::*;

    #[test]
    fn what_is_put_stays_in_range_and_of_its_kind() {
        let put = |name: &str, value| {
            let mut knobs = Knobs::new(KNOBS, (64, 48));
            knobs.put(name, value);
            knobs.changed().join(" ")
        };
        assert_eq!(put("tilt", Value::Number(1e300)), "tilt=80");
        assert_eq!(put("tilt", Value::Number(f64::NEG_INFINITY)), "tilt=0");
        assert_eq!(put("bits", Value::Whole(i32::MIN)), "bits=1");
        assert_eq!(put("p", Value::Point(dvec2(-9.0, f64::INFINITY))), "p=0,48");
        assert_eq!(put("rule", Value::Choice(2)), "rule=any");
        assert_eq!(put("clip", Value::Switch(false)), "clip=off");
        assert_eq!(put("paint", Value::Color(Color::GREEN)), "paint=00ff00");
        let ignored = [
            ("tilt", Value::Number(f64::NAN)),
            ("tilt", Value::Whole(1)),
            ("rule", Value::Choice(3)),
            ("p", Value::Point(dvec2(f64::NAN, 1.0))),
            ("other", Value::Switch(false)),
        ];
        for (name, value) in ignored {
            assert_eq!(put(name, value), "", "{name} {value:?}");
        }
    }

    #[test]
    fn texts_are_values_or_refused() {
        let mut knobs = Knobs::new(KNOBS, (64, 48));
        assert!(!knobs.is_empty() && Knobs::new(&[], (64, 48)).is_empty());
        for good in ["tilt=0", "tilt=80", "bits=8", "rule=top-left", "clip=off", "p=64,48", "paint=#00ff7f"] {
            assert_eq!(knobs.set(good), Ok(()), "{good}");
        }
        assert_eq!((knobs.number("tilt"), knobs.whole("bits"), knobs.choice("rule")), (80.0, 8, "top-left"));
        assert_eq!((knobs.is_on("clip"), knobs.point("p")), (false, dvec2(64.0, 48.0)));
        assert_eq!(knobs.color("paint"), Color::rgb(0, 255, 127));
        assert_eq!(
            knobs.changed(),
            ["tilt=80", "bits=8", "rule=top-left", "clip=off", "p=64,48", "paint=00ff7f"]
        );
        for (text, is_on) in [("on", true), ("0", false), ("true", true), ("false", false), ("1", true)] {
            assert_eq!(knobs.set(&format!("clip={text}")), Ok(()), "{text}");
            assert_eq!(knobs.is_on("clip"), is_on, "{text}");
        }
        let before = knobs.clone();
        for bad in [
            "tilt",
            "tilt=",
            "tilt=81",
            "tilt=-1",
            "tilt=nan",
            "tilt=inf",
            "bits=9",
            "bits=1.5",
            "rule=other",
            "clip=maybe",
            "p=65,0",
            "p=1",
            "p=1,2,3",
            "paint=#00ff7",
            "paint=#00ff7g",
            "other=1",
            "=1",
        ] {
            assert!(knobs.set(bad).is_err(), "{bad}");
        }
        assert_eq!(knobs, before, "what is refused changes nothing");
    }

    #[test]
    fn a_refusal_says_why() {
        let refusal = |text| Knobs::new(KNOBS, (64, 48)).set(text).expect_err("it is refused").to_string();
        assert_eq!(refusal("tilt"), "expected NAME=VALUE, not 'tilt'");
        assert_eq!(refusal("other=1"), "there is no knob 'other'");
        assert_eq!(refusal("tilt=81"), "'tilt' cannot be '81': it is a number, 0 to 80 °");
    }

    #[test]
    fn another_variant_takes_over_what_it_has() {
        let mut first = Knobs::new(KNOBS, (64, 48));
        first.set("tilt=50").expect("in range");
        first.set("bits=2").expect("in range");
        const OTHERS: &[Knob] =
            &[KNOBS[0], Knob::switch("bits", true, "of the same name, and something else")];
        let mut second = Knobs::new(OTHERS, (64, 48));
        second.take_over(&first);
        assert_eq!(second.changed(), ["tilt=50"]);
    }
}
