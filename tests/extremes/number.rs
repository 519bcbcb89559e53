//! Chapter 3: the numbers themselves. Lanes of several have tests beside them.

use rasterbook::real::{Mask, each};

use super::*;

/// A number as bits: zeros with their signs, all NaN as one.
fn bits<R: Scalar>(number: R) -> u64 {
    bits_of(number.into())
}

fn assert_rounded<R: Scalar>(number: R) {
    let (value, floor, root): (f64, f64, f64) = (number.into(), number.floor().into(), number.sqrt().into());
    if value.is_finite() {
        assert!(floor <= value && floor % 1.0 == 0.0, "{floor} of {value}");
        // The next one is greater; of large ones there is none between.
        assert!(floor + 1.0 > value || floor == value, "{floor} of {value}");
    }
    if !value.is_finite() || value == 0.0 {
        assert_eq!(bits_of(floor), bits_of(value));
    }
    // The square root of a single number in double precision, rounded once more, is rounded as if once.
    let expected: f64 = R::of(value.sqrt()).into();
    assert_eq!(bits_of(root), bits_of(expected));
    assert_eq!(root.is_nan(), value.is_nan() || value < 0.0);
}

fn assert_compared<R: Scalar>([a, b]: [R; 2]) {
    let (is_less, is_greater): (bool, bool) = (a.is_less(b), b.is_less(a));
    let [wide_a, wide_b]: [f64; 2] = [a.into(), b.into()];
    assert_eq!((is_less, is_greater), (wide_a < wide_b, wide_a > wide_b));
    assert_eq!(
        [a.min(b), a.max(b)].map(bits),
        [if is_less { a } else { b }, if is_greater { a } else { b }].map(bits)
    );
    for (mask, chosen) in [(true, a), (false, b), (is_less, a.min(b))] {
        assert_eq!(bits(R::select(mask, a, b)), bits(chosen));
        assert!(mask.and(mask) == mask && mask.not() != mask && !mask.and(mask.not()));
        assert_eq!(<bool as Mask>::all(mask), mask);
    }
}

fn assert_each<R: Scalar>(numbers: [f64; 9]) {
    let all: [R; 9] = R::array_of(numbers);
    assert_eq!(all.map(bits), numbers.map(|number| bits(R::of(number))));
    let turned = each(all, |k, number| if k == 8 { -number } else { number });
    assert_eq!(turned.map(bits), from_fn(|k| if k == 8 { bits(-all[8]) } else { bits(all[k]) }));
    for number in all {
        assert_eq!([number.map(|number| number), -(-number)].map(bits), [bits(number); 2]);
        assert_eq!(bits(number.map(|_| f64::MAX)), bits(R::of(f64::MAX)));
    }
    let turned = R::map_all([all[0], all[1]], |[a, b]| [b, a, f64::NAN]);
    assert_eq!(turned.map(bits), [all[1], all[0], R::of(f64::NAN)].map(bits));
}

fn assert_gathered<R: Scalar>(column: u32, row: u32, numbers: [f64; 3]) {
    // Whole numbers that both have.
    let place = [column, row].map(|place| place & 0xff_ffff);
    let [x, y] = place.map(|place| R::of(place.into()));
    let gathered = R::gather(x, y, |column, row| {
        assert_eq!([column, row], place.map(|place| place as usize));
        numbers
    });
    assert_eq!(gathered.map(bits), numbers.map(|number| bits(R::of(number))));

    let colors: Vec<Color> = (0..64).map(Color::gray).collect();
    let (column, row) = (column % 8, row % 8);
    let [x, y] = [column, row].map(|place| R::of(f64::from(place) + 0.75));
    let color = R::gather_color(x, y, 3, &colors);
    assert_eq!(color, Color::gray((8 * row + column) as u8), "fractions are cut off");
    assert_eq!(R::channels(color).map(Into::into), color.to_f64());
}

proptest! {
    #[test]
    fn formulas_of_any_numbers(numbers in numbers::<9>(), column in any::<u32>(), row in any::<u32>()) {
        let [a, b, c, ..] = numbers;
        assert_rounded::<f64>(a);
        assert_rounded::<f32>(a as f32);
        assert_compared::<f64>([a, b]);
        assert_compared::<f32>([a as f32, b as f32]);
        assert_compared::<f64>([a, a]);
        assert_each::<f64>(numbers);
        assert_each::<f32>(numbers);
        assert_gathered::<f64>(column, row, [a, b, c]);
        assert_gathered::<f32>(column, row, [a, b, c]);
    }
}
