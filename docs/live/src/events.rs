//! What a page says, as events.

use rasterbook::figure::RasterizerChoice;
use rasterbook::live::{Event, Live, View};

/// The most pixels that a page may ask for: a canvas is not larger than a screen.
const MOST_PIXELS: u32 = 1 << 22;

/// A line such as `set tilt=60`, `drag 12,40` or `reset`; `None` if it says nothing that the figure can do.
pub(crate) fn parse(line: &str, live: &Live<'_>) -> Option<Event> {
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    Some(match word {
        "set" => {
            let (index, value) = live.scene().knobs.read(rest).ok()?;
            Event::Set(index, value)
        }
        "reset" => Event::Reset,
        "run" => Event::Run,
        "sweep" => Event::Sweep,
        "tick" => Event::Tick,
        "release" => Event::Release,
        "press" => Event::Press(pair(rest, ',')?),
        "drag" => Event::Drag(pair(rest, ',')?),
        "frame" => Event::Frame(rest.parse().ok()?),
        "size" => {
            let (width, height): (u32, u32) = pair(rest, 'x')?;
            let pixels = width.checked_mul(height)?;
            return (1..=MOST_PIXELS).contains(&pixels).then_some(Event::Resize((width, height)));
        }
        "rasterizer" => {
            let all = RasterizerChoice::ALL;
            Event::Rasterizer(*all.iter().find(|choice| choice.name() == rest)?)
        }
        "show" => {
            let view = match rest {
                "itself" => View::Itself,
                "remedy" => View::Remedy,
                "difference" => View::Difference,
                "overdraw" => View::Overdraw,
                _ => return None,
            };
            // Shown twice, a view is left; a page asks for the one that it wants.
            Event::Show(if live.view() == view { View::Itself } else { view })
        }
        _ => return None,
    })
}

/// Two numbers with a character between them.
fn pair<T: std::str::FromStr>(text: &str, between: char) -> Option<(T, T)> {
    let (a, b) = text.split_once(between)?;
    Some((a.parse().ok()?, b.parse().ok()?))
}
