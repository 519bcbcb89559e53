//! Chapter 11: light.

use rasterbook::light::{
    Highlight, Light, Material, add, attenuation, blinn_phong, dot, lambert, mapped_normal, normalize, phong,
    reflect, scale, subtract,
};

use super::*;

const HIGHLIGHTS: [Highlight; 3] = [Highlight::None, Highlight::Phong, Highlight::BlinnPhong];
/// Exponents at whose powers multiplying ends, and others.
const EXPONENTS: [f64; 9] = [0.0, -0.0, 0.5, 1.0, 1024.0, 1025.0, 4_294_967_296.0, f64::MAX, f64::INFINITY];

fn wide<R: Scalar>(numbers: [R; 3]) -> [f64; 3] {
    numbers.map(Into::into)
}

fn is_finite<R: Scalar>(numbers: [R; 3]) -> bool {
    wide(numbers).iter().all(|number| number.is_finite())
}

/// The same numbers, bit for bit.
fn assert_same<R: Scalar>(found: [R; 3], expected: impl Fn(usize) -> R) {
    let expected = wide(from_fn(expected)).map(bits_of);
    assert_eq!(wide(found).map(bits_of), expected, "{found:?}");
}

fn assert_vectors<R: Scalar>(a: [R; 3], b: [R; 3], least: f64) {
    let zero = R::of(0.0);
    assert_same(add(a, b), |i| a[i] + b[i]);
    assert_same(subtract(a, b), |i| a[i] - b[i]);
    assert_same(scale(a, b[0]), |i| a[i] * b[0]);
    assert_same([dot(a, b); 3], |_| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    if is_finite(b) {
        assert!(reflect([zero; 3], b) == b.map(|number| -number), "of no normal, the opposite");
    }

    let (square, unit): (f64, _) = (dot(a, a).into(), normalize(a));
    if square == 0.0 {
        assert!(!is_finite(unit), "{a:?} becomes {unit:?}");
    } else if square.is_infinite() && is_finite(a) {
        assert!(unit == [zero; 3], "{a:?} becomes {unit:?}");
    } else if square.is_finite() && square >= least {
        let length: f64 = dot(unit, unit).into();
        assert!((length - 1.0).abs() < 1e-6, "{a:?} becomes {unit:?}");
        assert!(
            (0..3).all(|i| (a[i] > zero) == (unit[i] > zero) || unit[i] == zero),
            "{a:?} becomes {unit:?}"
        );
    }
}

fn assert_highlights<R: Scalar>(normal: [R; 3], to_light: [R; 3], to_eye: [R; 3], exponent: f64) {
    let zero = R::of(0.0);
    assert!(lambert(normal, to_light) >= zero);
    let highlights = [phong, blinn_phong].map(|model| model(normal, to_light, to_eye, exponent));
    assert!(highlights.iter().all(|&highlight| highlight >= zero), "{highlights:?}");
    if is_finite(to_light) {
        let opposite = to_light.map(|number| -number);
        let expected = if exponent == 0.0 { 1.0 } else { 0.0 };
        assert!(
            blinn_phong(normal, to_light, opposite, exponent) == R::of(expected),
            "there is no half vector"
        );
    }
}

fn assert_lamps<R: Scalar>(position: [f64; 3], place: [R; 3], intensity: f64) {
    let (direction, brightness) = Light::Directional(position).at(place);
    assert_same(direction, |i| R::of(position[i]));
    assert!(brightness == R::of(1.0));

    let lamp = Light::Point { position, intensity };
    let (direction, _) = lamp.at(place);
    assert_same(direction, |i| {
        let offset = from_fn(|k| R::of(position[k]) - place[k]);
        offset[i] / dot(offset, offset).sqrt()
    });
    let (direction, brightness) = lamp.at(position.map(R::of));
    let brightness: f64 = brightness.into();
    assert!(
        !is_finite(direction) && !brightness.is_finite(),
        "at the light itself: {direction:?} {brightness}"
    );
}

fn assert_shades<R: Scalar>(numbers: [f64; 8], vectors: [[R; 3]; 3], highlight: Highlight, exponent: f64) {
    let [ambient, diffuse, specular, intensity, surface @ .., _] = numbers;
    let [normal, to_light, to_eye] = vectors;
    let shade = |[ambient, diffuse, specular]: [f64; 3], surface: [f64; 3], intensity: f64| {
        let material = Material { ambient, diffuse, specular, exponent, highlight };
        wide(material.shade(surface.map(R::of), normal, (to_light, R::of(intensity)), to_eye))
    };
    let any = shade([ambient, diffuse, specular], surface, intensity);
    assert!(any.iter().all(|&channel| channel <= 255.0), "{any:?}");
    // Of what is not negative nothing becomes so.
    let parts = [ambient, diffuse, specular].map(f64::abs);
    assert_within(shade(parts, surface.map(f64::abs), intensity.abs()), [0.0, 255.0]);
    let at_the_lamp = Light::Point { position: surface, intensity }.at(surface.map(R::of));
    let material = Material { ambient, diffuse: 0.5, specular, exponent, highlight };
    let there = wide(material.shade([R::of(9.0); 3], normal, at_the_lamp, to_eye));
    assert_eq!(there, [255.0; 3], "neither direction nor brightness is a number");
}

fn assert_mapped<R: Scalar>(texel: [f64; 3], shades: [u8; 3], axes: [[R; 3]; 3]) {
    let level: [[R; 3]; 3] = from_fn(|i| from_fn(|k| R::of(if i == k { 1.0 } else { 0.0 })));
    let normal = mapped_normal(shades.map(|shade| R::of(shade.into())), level);
    let length: f64 = dot(normal, normal).into();
    assert!((length - 1.0).abs() < 1e-6, "{shades:?} give {normal:?}");
    assert!(!is_finite(mapped_normal([R::of(127.5); 3], level)));
    assert!(!is_finite(mapped_normal(texel.map(R::of), [[R::of(0.0); 3]; 3])), "there are no axes");
    let _ = mapped_normal(texel.map(R::of), axes);
}

fn assert_lit<R: Scalar>(numbers: [f64; 17], shades: [u8; 3], exponent: f64, least: f64) {
    let vectors: [[f64; 3]; 3] = from_fn(|k| from_fn(|i| numbers[3 * k + i]));
    let [a, b, c] = vectors.map(reals::<R, 3>);
    assert_vectors(a, b, least);
    assert_highlights(a, b, c, exponent);
    assert_lamps(vectors[0], b, numbers[9]);
    for highlight in HIGHLIGHTS {
        assert_shades(from_fn(|i| numbers[9 + i]), [a, b, c], highlight, exponent);
    }
    assert_mapped(vectors[0], shades, [a, b, c]);
    let arrived: f64 = attenuation(a[0]).into();
    assert!(arrived >= 0.0 || vectors[0][0].is_nan(), "{arrived} of {}", vectors[0][0]);
    assert_eq!(Into::<f64>::into(attenuation(R::of(0.0))), f64::INFINITY);
}

proptest! {
    #[test]
    fn surfaces_under_any_light(
        numbers in numbers(), shades in any::<[u8; 3]>(),
        exponent in prop_oneof![select(&EXPONENTS[..]), any_number().prop_map(f64::abs)],
    ) {
        let exponent = if exponent.is_nan() { 2.5 } else { exponent };
        // Squares from here on are as exact as other numbers.
        assert_lit::<f64>(numbers, shades, exponent, 1e-300);
        assert_lit::<f32>(numbers, shades, exponent, 1e-36);
    }
}
