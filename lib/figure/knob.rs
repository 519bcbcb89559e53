//! One knob: what it can be set to, as text and on the way through its range.

use glam::{DVec2, dvec2};

use crate::color::Color;

/// One knob: a row of a variant's table of knobs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knob {
    /// How it is called on the command line.
    pub name: &'static str,
    /// What can be set, and to what it is set at first.
    pub kind: Kind,
    /// What to watch while it is turned.
    pub watch: &'static str,
}

/// What a knob holds: a default, and a range where the kind has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number, both ends of its range included.
    Number {
        /// The value of the pinned picture.
        default: f64,
        /// The smallest and the largest value.
        range: [f64; 2],
        /// Such as `°`; empty for a plain number.
        unit: &'static str,
    },
    /// A whole number.
    Whole {
        /// The value of the pinned picture.
        default: i32,
        /// The smallest and the largest value.
        range: [i32; 2],
        /// Such as `bits`; empty for a plain number.
        unit: &'static str,
    },
    /// One of several names; the first is the default.
    Choice(&'static [&'static str]),
    /// On or off.
    Switch(bool),
    /// A point of the picture, pixels of the variant's own size, y up from the bottom.
    Point([f64; 2]),
    /// A color.
    Color(Color),
}

impl Knob {
    /// A number with its default, its range and its unit.
    #[must_use]
    pub const fn number(
        name: &'static str,
        default: f64,
        range: [f64; 2],
        unit: &'static str,
        watch: &'static str,
    ) -> Self {
        Self { name, kind: Kind::Number { default, range, unit }, watch }
    }

    /// A whole number with its default, its range and its unit.
    #[must_use]
    pub const fn whole(
        name: &'static str,
        default: i32,
        range: [i32; 2],
        unit: &'static str,
        watch: &'static str,
    ) -> Self {
        Self { name, kind: Kind::Whole { default, range, unit }, watch }
    }

    /// One of several names, the first at first.
    #[must_use]
    pub const fn choice(name: &'static str, names: &'static [&'static str], watch: &'static str) -> Self {
        Self { name, kind: Kind::Choice(names), watch }
    }

    /// Something that is on or off.
    #[must_use]
    pub const fn switch(name: &'static str, default: bool, watch: &'static str) -> Self {
        Self { name, kind: Kind::Switch(default), watch }
    }

    /// A point of the picture.
    #[must_use]
    pub const fn point(name: &'static str, default: [f64; 2], watch: &'static str) -> Self {
        Self { name, kind: Kind::Point(default), watch }
    }

    /// A color.
    #[must_use]
    pub const fn color(name: &'static str, default: Color, watch: &'static str) -> Self {
        Self { name, kind: Kind::Color(default), watch }
    }

    /// What it is set to at first.
    #[must_use]
    pub const fn default(&self) -> Value {
        match self.kind {
            Kind::Number { default, .. } => Value::Number(default),
            Kind::Whole { default, .. } => Value::Whole(default),
            Kind::Choice(_) => Value::Choice(0),
            Kind::Switch(default) => Value::Switch(default),
            Kind::Point([x, y]) => Value::Point(dvec2(x, y)),
            Kind::Color(default) => Value::Color(default),
        }
    }

    /// The value at a fraction of its range, 0..=1; `None` for points and colors, which have no order.
    #[must_use]
    pub fn at(&self, fraction: f64) -> Option<Value> {
        let whole = |first: i32, last: i32| {
            let count = f64::from(last) - f64::from(first) + 1.0;
            // Every value for as long as every other one.
            ((f64::from(first) + (fraction * count).floor()) as i32).min(last)
        };
        match self.kind {
            // The ends exactly.
            Kind::Number { range: [low, high], .. } => {
                let value = low * (1.0 - fraction) + high * fraction;
                // Not more digits than somebody reads.
                Some(Value::Number(((value * 1e4).round() / 1e4).clamp(low, high)))
            }
            Kind::Whole { range: [low, high], .. } => Some(Value::Whole(whole(low, high))),
            Kind::Choice(names) => Some(Value::Choice(whole(0, names.len() as i32 - 1) as usize)),
            Kind::Switch(_) => Some(Value::Switch(fraction >= 0.5)),
            Kind::Point(_) | Kind::Color(_) => None,
        }
    }

    /// The value that is so many steps of a key from `value`, kept in range. A number has at least 60 round steps, a point
    /// moves to the right by a pixel, a color becomes brighter by a 16th; choices and switches go round.
    #[must_use]
    pub fn stepped(&self, value: Value, steps: i32) -> Value {
        match (self.kind, value) {
            (Kind::Number { range: [low, high], .. }, Value::Number(value)) => {
                let stepped = value + round_step((high - low) / 60.0) * f64::from(steps);
                // Without the dust that adding leaves: 0.30000000000000004.
                Value::Number(((stepped * 1e9).round() / 1e9).clamp(low, high))
            }
            (Kind::Whole { range: [low, high], .. }, Value::Whole(value)) => {
                Value::Whole(value.saturating_add(steps).clamp(low, high))
            }
            (Kind::Choice(names), Value::Choice(value)) => {
                Value::Choice((value as i64 + i64::from(steps)).rem_euclid(names.len() as i64) as usize)
            }
            (Kind::Switch(_), Value::Switch(value)) => Value::Switch(value != (steps % 2 != 0)),
            (Kind::Point(_), Value::Point(point)) => Value::Point(point + dvec2(f64::from(steps), 0.0)),
            (Kind::Color(_), Value::Color(color)) => {
                Value::Color(Color::truncated(color.to_f64().map(|c| c + 16.0 * f64::from(steps))))
            }
            (_, other) => other,
        }
    }

    /// A value of its kind, brought into its range; `None` for what has no place there. `size` is that of the picture.
    pub(super) fn clamped(&self, value: Value, size: (u32, u32)) -> Option<Value> {
        match (self.kind, value) {
            (Kind::Number { range: [low, high], .. }, Value::Number(number)) if !number.is_nan() => {
                Some(Value::Number(number.clamp(low, high)))
            }
            (Kind::Whole { range: [low, high], .. }, Value::Whole(number)) => {
                Some(Value::Whole(number.clamp(low, high)))
            }
            (Kind::Choice(names), Value::Choice(index)) => (index < names.len()).then_some(value),
            (Kind::Switch(_), Value::Switch(_)) | (Kind::Color(_), Value::Color(_)) => Some(value),
            (Kind::Point(_), Value::Point(point)) if !point.is_nan() => {
                Some(Value::Point(in_picture(point, size)))
            }
            _ => None,
        }
    }

    /// Its kind and range in words, such as `a number, 0 to 80 °`.
    #[must_use]
    pub fn range(&self) -> String {
        let with_unit = |text: String, unit: &str| {
            if unit.is_empty() { text } else { format!("{text} {unit}") }
        };
        match self.kind {
            Kind::Number { range: [low, high], unit, .. } => {
                with_unit(format!("a number, {low} to {high}"), unit)
            }
            Kind::Whole { range: [low, high], unit, .. } => {
                with_unit(format!("a whole number, {low} to {high}"), unit)
            }
            Kind::Choice(names) => names.join(" | "),
            Kind::Switch(_) => "on | off".to_owned(),
            Kind::Point(_) => "a point, X,Y in pixels of the variant's own size, y up".to_owned(),
            Kind::Color(_) => "a color, RRGGBB".to_owned(),
        }
    }

    /// A value as it is written after `=`.
    #[must_use]
    pub fn shown(&self, value: Value) -> String {
        match (self.kind, value) {
            (Kind::Choice(names), Value::Choice(index)) if index < names.len() => names[index].to_owned(),
            (_, Value::Switch(on)) => if on { "on" } else { "off" }.to_owned(),
            (_, Value::Number(value)) => short(value),
            (_, Value::Whole(value)) => format!("{value}"),
            (_, Value::Point(point)) => format!("{},{}", short(point.x), short(point.y)),
            (_, Value::Color(color)) => {
                let [red, green, blue] = color.channels();
                format!("{red:02x}{green:02x}{blue:02x}")
            }
            (_, Value::Choice(index)) => index.to_string(),
        }
    }

    /// The value that a text names, if it is in range; `size` is that of the variant's own picture.
    pub(super) fn parse(&self, text: &str, size: (u32, u32)) -> Option<Value> {
        let finite = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        match self.kind {
            Kind::Number { range: [low, high], .. } => {
                finite(text).filter(|value| (low..=high).contains(value)).map(Value::Number)
            }
            Kind::Whole { range: [low, high], .. } => {
                let value = text.trim().parse::<i32>().ok();
                value.filter(|value| (low..=high).contains(value)).map(Value::Whole)
            }
            Kind::Choice(names) => names.iter().position(|name| *name == text).map(Value::Choice),
            Kind::Switch(_) => match text {
                "on" | "true" | "1" => Some(Value::Switch(true)),
                "off" | "false" | "0" => Some(Value::Switch(false)),
                _ => None,
            },
            Kind::Point(_) => {
                let (x, y) = text.split_once(',')?;
                let point = dvec2(finite(x)?, finite(y)?);
                (point == in_picture(point, size)).then_some(Value::Point(point))
            }
            Kind::Color(_) => parse_color(text).map(Value::Color),
        }
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not larger than `most`.
fn round_step(most: f64) -> f64 {
    let ten = libm::pow(10.0, libm::log10(most).floor());
    [5.0, 2.0, 1.0].map(|times| times * ten).into_iter().find(|step| *step <= most).unwrap_or(ten)
}

/// A number as it is written after `=`, and in the names of files: with an exponent, if it is long otherwise.
fn short(value: f64) -> String {
    // So many characters hold 17 digits, a sign, a point, and the 0 before it.
    let text = format!("{value}");
    if text.len() > 20 { format!("{value:e}") } else { text }
}

/// The nearest point of the picture.
fn in_picture(point: DVec2, (width, height): (u32, u32)) -> DVec2 {
    point.clamp(DVec2::ZERO, dvec2(f64::from(width), f64::from(height)))
}

/// `#RRGGBB`, with or without the number sign.
fn parse_color(text: &str) -> Option<Color> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let is_hexadecimal = digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let word = is_hexadecimal.then(|| u32::from_str_radix(digits, 16).ok())??;
    let [_, red, green, blue] = word.to_be_bytes();
    Some(Color::rgb(red, green, blue))
}

/// What a knob is set to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Of a number.
    Number(f64),
    /// Of a whole number.
    Whole(i32),
    /// The index of a name.
    Choice(usize),
    /// On or off.
    Switch(bool),
    /// Of a point.
    Point(DVec2),
    /// Of a color.
    Color(Color),
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// One of each kind.
    pub(in super::super) const KNOBS: &[Knob] = &[
        Knob::number("tilt", 30.0, [0.0, 80.0], "°", "-"),
        Knob::whole("bits", 4, [1, 8], "", "-"),
        Knob::choice("rule", &["book", "top-left", "any"], "-"),
        Knob::switch("clip", true, "-"),
        Knob::point("p", [3.5, 4.0], "-"),
        Knob::color("paint", Color::RED, "-"),
    ];

    #[test]
    fn a_sweep_reaches_both_ends() {
        let at = |index: usize, fraction: f64| KNOBS[index].at(fraction);
        assert_eq!([at(0, 0.0), at(0, 0.5), at(0, 1.0)], [0.0, 40.0, 80.0].map(|v| Some(Value::Number(v))));
        assert_eq!([at(1, 0.0), at(1, 0.5), at(1, 1.0)], [1, 5, 8].map(|v| Some(Value::Whole(v))));
        assert_eq!([at(2, 0.0), at(2, 1.0)], [0, 2].map(|v| Some(Value::Choice(v))));
        assert_eq!([at(3, 0.0), at(3, 1.0)], [false, true].map(|v| Some(Value::Switch(v))));
        assert_eq!((at(4, 0.5), at(5, 0.5)), (None, None));
    }

    #[test]
    fn steps_stay_in_range_or_go_round() {
        let stepped = |index: usize, steps| KNOBS[index].stepped(KNOBS[index].default(), steps);
        assert_eq!(stepped(0, 3), Value::Number(33.0));
        let steps = [80.0, 360.0, 1.0, 120.0, 59.0].map(|range: f64| round_step(range / 60.0));
        assert_eq!(steps, [1.0, 5.0, 0.01, 2.0, 0.5]);
        let angle = Knob::number("angle", 0.0, [-180.0, 180.0], "°", "-");
        assert_eq!(angle.stepped(Value::Number(30.0), 2), Value::Number(40.0));
        assert_eq!(stepped(0, 1000), Value::Number(80.0));
        assert_eq!(stepped(1, -9), Value::Whole(1));
        assert_eq!(stepped(2, 1), Value::Choice(1));
        assert_eq!(stepped(2, -1), Value::Choice(2));
        assert_eq!((stepped(3, 1), stepped(3, 2)), (Value::Switch(false), Value::Switch(true)));
        assert_eq!(stepped(4, 2), Value::Point(dvec2(5.5, 4.0)));
        assert_eq!(stepped(5, 2), Value::Color(Color::rgb(255, 32, 32)));
        let choices = [1, 3].map(|index| KNOBS[2].shown(Value::Choice(index)));
        assert_eq!(choices, ["top-left", "3"], "of what has no name, the number");
    }

    #[test]
    fn no_number_is_long() {
        for (value, text) in
            [(-0.123_456_789_012_345_66, "-0.12345678901234566"), (1e-300, "1e-300"), (-0.0, "-0")]
        {
            assert_eq!(KNOBS[0].shown(Value::Number(value)), text);
            assert_eq!(text.parse(), Ok(value));
        }
        assert_eq!(KNOBS[4].shown(Value::Point(dvec2(5e-324, 7.0))), "5e-324,7");
    }

    #[test]
    fn a_range_is_told_in_words() {
        let bare = Knob::number("near", 1.0, [0.5, 2.0], "", "-");
        let ranges: Vec<String> = KNOBS.iter().chain([&bare]).map(Knob::range).collect();
        assert_eq!(
            ranges,
            [
                "a number, 0 to 80 °",
                "a whole number, 1 to 8",
                "book | top-left | any",
                "on | off",
                "a point, X,Y in pixels of the variant's own size, y up",
                "a color, RRGGBB",
                "a number, 0.5 to 2",
            ]
        );
    }
}
