//! Whether all renderers draw the same picture.

use std::error::Error;

use crate::contestant::Contestant;
use crate::ours::Coverage;
use crate::peers::REFERENCE;
use crate::picture::Difference;
use crate::say;

/// How much may differ: the part of the covered pixels that is covered in one picture alone, and the mean difference of
/// the channels, of 255. Who samples half a pixel aside takes another texel now and then.
const fn allowed(coverage: Coverage) -> (f64, f64) {
    match coverage {
        Coverage::Exact => (0.0, 0.5),
        Coverage::Near => (0.02, 10.0),
    }
}

/// Compares the pictures with the reference's, or with the first one's if there is no reference, and says what differs.
/// Not the same picture is an error.
pub(crate) fn pictures(contestants: &mut [Contestant]) -> Result<(), Box<dyn Error>> {
    let place = contestants.iter().position(|c| c.peer.name == REFERENCE);
    let place = place.or(contestants.iter().position(|c| c.peer.coverage == Coverage::Exact)).unwrap_or(0);
    let Some(reference) = contestants.get_mut(place) else { return Ok(()) };
    let expected = reference.picture()?;
    for contestant in contestants {
        let difference = Difference::between(&contestant.picture()?, &expected);
        let Difference { uncovered, common, mean, others } = difference;
        say(&format!(
            "  {:22}{} thread{}: {uncovered:6} of {common} pixels covered differently, {others:7} in another color, mean {mean:.3}",
            contestant.name(),
            contestant.threads,
            if contestant.threads == 1 { " " } else { "s" },
        ))?;
        let (part, most) = allowed(contestant.peer.coverage);
        if common == 0 || uncovered as f64 > part * common as f64 || mean > most {
            return Err(format!("{} does not draw the same picture", contestant.name()).into());
        }
    }
    Ok(())
}
