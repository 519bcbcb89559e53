//! The live window: its keys and buttons become events of [`crate::live`], and it shows the picture that comes of them.

mod painter;

use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::thread::scope;
use std::time::{Duration, Instant};

use minifb::{InputCallback, Key, MouseButton, MouseMode, Window, WindowOptions};

use self::painter::{Gone, Painted, Painter};
use super::arguments::Request;
use super::failure::Failure;
use super::output::{Destination, note, say};
use super::scenes::{load, picture_name, runtime_failure, scene_of, sweepable};
use crate::color::Color;
use crate::figure::{Chapter, Variant};
use crate::framebuffer::Framebuffer;
use crate::inspect::heat_legend;
use crate::live::{Event, Live, View};
use crate::rect::Pixel;

/// What the keys and the mouse do.
const HELP: &str = "\
Tab, up, down   the next or the previous knob        M      the remedy of a mistake
left, right     turn it                              Space  run or stop the animation, or the knob
K               let the knob go through its range    Home   knobs and frame as at first
1 to 9 , .      another variant                      D      where the two differ
wheel, + -      single pixels, and back              O      how often each pixel was written
drag            a point, or the model                R      the next rasterizer
click           what happened at the pixel           S      save what is seen
H ?             these lines                          Esc    close";

/// What is around the picture.
const BORDER: u32 = 0x20_20_20;
/// A small picture is shown as large as it fits into so many pixels by a whole number.
const ROOM: (u32, u32) = (640, 480);
/// The most pictures a second.
const RATE: usize = 60;
/// How long the window waits for a picture before it shows a draft.
const PATIENCE: Duration = Duration::from_millis(8);
/// Of a picture that takes so long, a draft's sides are a fourth as long; of others, half as long.
const LONG: Duration = Duration::from_millis(80);

/// Opens the window on a variant, and returns when it is closed. What is saved goes to `destination`.
pub(super) fn open_window(
    chapter: &Chapter,
    variant: &Variant,
    request: &Request,
    destination: &Destination,
) -> Result<(), Failure> {
    if *destination == Destination::Output {
        return Err(Failure::Usage(
            "what is saved in a window goes into a folder or a file: --out - is neither".to_owned(),
        ));
    }
    let given = load(request)?;
    let mut live = Live::new(chapter, scene_of(variant, request, &given)?, given);
    if let Some(name) = &request.sweep {
        sweepable(variant, name, request)?;
        live.take_knob(name);
        live.apply(Event::Sweep).map_err(runtime_failure)?;
    }
    show(live, destination)
}

/// Shows what is looked at until the window is closed.
fn show(live: Live<'_>, destination: &Destination) -> Result<(), Failure> {
    let (width, height) = live.scene().size;
    let scale = (ROOM.0 / width).min(ROOM.1 / height).max(1);
    let options = WindowOptions { resize: true, ..WindowOptions::default() };
    let size = [width, height].map(|side| (side * scale) as usize);
    let mut window = Window::new(live.scene().variant.name, size[0], size[1], options).map_err(no_window)?;
    window.set_target_fps(RATE);
    let keys = Keys::default();
    window.set_input_callback(Box::new(keys.clone()));
    note(HELP);
    scope(|scope| {
        let mut view = Viewer {
            live,
            painter: Painter::start(scope).map_err(no_thread)?,
            drafter: Painter::start(scope).map_err(no_thread)?,
            changes: 1,
            destination,
            shown: Shown::default(),
            keys,
            is_closed: false,
            pointer: None,
            pressed: None,
            ticked: Instant::now(),
        };
        while window.is_open() && !view.is_closed {
            view.frame(&mut window)?;
        }
        let Shown { count, slowest, longest_wait, .. } = view.shown;
        let [slowest, wait] = [slowest, longest_wait].map(|time| time.as_secs_f64() * 1e3);
        note(&format!(
            "{count} pictures drawn, the slowest in {slowest:.1} ms; the window never waited longer than {wait:.1} ms"
        ));
        Ok(())
    })
}

fn no_thread(error: io::Error) -> Failure {
    Failure::Runtime(format!("the thread that draws cannot be started: {error}"))
}

fn gone(_: Gone) -> Failure {
    Failure::Runtime("the thread that draws has ended".to_owned())
}

fn no_window(error: minifb::Error) -> Failure {
    Failure::Runtime(format!(
        "no window can be opened ({error}): is there a display? --show draws in the terminal"
    ))
}

/// The keys that went down since the last round. Asking which are down would miss one that goes up within a round.
#[derive(Clone, Default)]
struct Keys(Rc<RefCell<Vec<Key>>>);

impl InputCallback for Keys {
    fn add_char(&mut self, _: u32) {}

    fn set_key_state(&mut self, key: Key, is_down: bool) {
        if is_down {
            self.0.borrow_mut().push(key);
        }
    }
}

impl Keys {
    fn take(&self) -> Vec<Key> {
        self.0.take()
    }
}

/// The picture on the window, and what drawing cost.
#[derive(Default)]
struct Shown {
    /// The whole picture, if it is shown.
    whole: Option<Framebuffer>,
    /// What is shown of it, or a draft.
    picture: Option<Framebuffer>,
    /// After how many changes each was drawn.
    whole_of: u64,
    picture_of: u64,
    /// After how many changes a draft was begun last.
    drafted: u64,
    buffer: Vec<u32>,
    size: (usize, usize),
    title: String,
    took: Duration,
    count: u32,
    slowest: Duration,
    /// The longest time in which the window waited for a picture.
    longest_wait: Duration,
}

impl Shown {
    /// Another picture takes the place of the one that is shown.
    fn show(&mut self, picture: Framebuffer, number: u64) {
        (self.whole, self.picture, self.picture_of) = (None, Some(picture), number);
        // It has to be laid out.
        self.size = (0, 0);
    }
}

/// How the picture lies in the window: its scale, and where its upper left pixel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    scale: i32,
    left: i32,
    top: i32,
    height: i32,
}

impl Layout {
    /// The largest whole-number scale at which the picture fits, in the middle.
    fn new((width, height): (usize, usize), picture: &Framebuffer) -> Self {
        let [width, height] = [width, height].map(|side| i32::try_from(side).unwrap_or(i32::MAX));
        let [columns, rows] = [picture.width(), picture.height()].map(|side| side as i32);
        let scale = (width / columns).min(height / rows).max(1);
        let [left, top] = [width - columns * scale, height - rows * scale].map(|rest| rest.div_euclid(2));
        Self { scale, left, top, height: rows }
    }

    /// The pixel of the picture at a place of the window, y up; it may lie outside.
    const fn pixel(&self, (x, y): (i32, i32)) -> Pixel {
        ((x - self.left).div_euclid(self.scale), self.height - 1 - (y - self.top).div_euclid(self.scale))
    }
}

struct Viewer<'a> {
    live: Live<'a>,
    /// Draws whole pictures.
    painter: Painter<'a>,
    /// Draws drafts.
    drafter: Painter<'a>,
    /// How often what is looked at has changed.
    changes: u64,
    destination: &'a Destination,
    shown: Shown,
    keys: Keys,
    is_closed: bool,
    /// The pixel of the shown picture under the pointer.
    pointer: Option<Pixel>,
    /// Where the button went down, if it has not moved since.
    pressed: Option<Pixel>,
    ticked: Instant,
}

impl Viewer<'_> {
    /// One round: what came in, then what is seen.
    fn frame(&mut self, window: &mut Window) -> Result<(), Failure> {
        for key in self.keys.take() {
            self.key(key)?;
        }
        self.mouse(window)?;
        let due = self.live.rate().is_some_and(|rate| self.ticked.elapsed() >= Duration::from_secs(1) / rate);
        if due {
            self.ticked = Instant::now();
            self.apply(Event::Tick)?;
        }
        self.draw(window)
    }

    fn apply(&mut self, event: Event) -> Result<(), Failure> {
        let changed = self.live.apply(event).map_err(runtime_failure)?;
        self.changes += u64::from(changed);
        Ok(())
    }

    fn key(&mut self, key: Key) -> Result<(), Failure> {
        let here =
            self.pointer.filter(|pointer| self.live.pixel_at(*pointer).is_some()).unwrap_or_else(|| {
                let (width, height) = self.live.scene().size;
                (width as i32 / 2, height as i32 / 2)
            });
        self.tell_without_effect(key);
        let event = match key {
            Key::Tab | Key::Down => Event::NextKnob(1),
            Key::Up => Event::NextKnob(-1),
            Key::Left => Event::Turn(-1),
            Key::Right => Event::Turn(1),
            Key::Home => Event::Reset,
            Key::Space => Event::Run,
            Key::K => Event::Sweep,
            Key::M => Event::Show(View::Remedy),
            Key::D => Event::Show(View::Difference),
            Key::O => Event::Show(View::Overdraw),
            Key::R => Event::NextRasterizer,
            Key::Comma => Event::NextVariant(-1),
            Key::Period => Event::NextVariant(1),
            Key::Equal | Key::NumPadPlus => Event::Magnify(1, here),
            Key::Minus | Key::NumPadMinus => Event::Magnify(-1, here),
            Key::S => {
                self.save();
                return Ok(());
            }
            Key::Escape => {
                self.is_closed = true;
                return Ok(());
            }
            Key::H | Key::Slash => {
                note(HELP);
                return Ok(());
            }
            other => match digit(other) {
                Some(digit) => Event::Variant(digit - 1),
                None => return Ok(()),
            },
        };
        self.apply(event)
    }

    /// Says of a key why nothing happens, if nothing does; and what overdraw's colors mean.
    fn tell_without_effect(&self, key: Key) {
        let variant = self.live.scene().variant;
        let is_knob = matches!(key, Key::Tab | Key::Up | Key::Down | Key::Left | Key::Right | Key::K);
        let lacks = match key {
            Key::M | Key::D if self.live.remedy().is_none() => "remedy",
            Key::R if variant.rasterizer.is_none() => "choice of rasterizers",
            _ if is_knob && variant.knobs.is_empty() => "knobs",
            Key::Space if variant.animation.is_none() && variant.knobs.is_empty() => "animation and no knobs",
            Key::O if self.live.view() != View::Overdraw => return note(&heat_legend()),
            _ => return,
        };
        note(&format!("'{}' has no {lacks}", variant.name));
    }

    fn mouse(&mut self, window: &Window) -> Result<(), Failure> {
        let Some(picture) = &self.shown.picture else {
            return Ok(());
        };
        let layout = Layout::new(self.shown.size, picture);
        let place = window.get_mouse_pos(MouseMode::Pass).map(|(x, y)| (x.floor() as i32, y.floor() as i32));
        let pixel = place.map(|place| layout.pixel(place));
        let moved = pixel != self.pointer;
        self.pointer = pixel;
        let Some(pixel) = pixel else {
            return Ok(());
        };
        if let Some((_, notches)) = window.get_scroll_wheel().filter(|(_, notches)| *notches != 0.0) {
            self.apply(Event::Magnify(if notches > 0.0 { 1 } else { -1 }, pixel))?;
        }
        match (window.get_mouse_down(MouseButton::Left), self.live.is_held()) {
            (true, false) => {
                self.pressed = Some(pixel);
                self.apply(Event::Press(pixel))
            }
            (true, true) if moved => {
                self.pressed = None;
                self.apply(Event::Drag(pixel))
            }
            (false, true) => {
                self.apply(Event::Release)?;
                // A click, not a drag.
                self.pressed.take().map_or(Ok(()), |pixel| self.tell(pixel))
            }
            _ => Ok(()),
        }
    }

    /// Prints the history of a pixel.
    fn tell(&self, pixel: Pixel) -> Result<(), Failure> {
        self.live.pixel_at(pixel).map_or(Ok(()), |pixel| say(&self.live.history(pixel).to_string()))
    }

    /// Writes what is seen into a file. Where that fails, the window stays.
    fn save(&self) {
        let view = match self.live.view() {
            View::Itself => "",
            View::Remedy => "-remedy",
            View::Difference => "-difference",
            View::Overdraw => "-overdraw",
        };
        let scene = self.live.scene();
        let frame = scene.variant.animation.map(|_| scene.frame);
        let rasterizer = scene.variant.rasterizer.map(|_| scene.rasterizer);
        let name = format!("{}{view}-seen", picture_name(scene, frame, rasterizer, self.live.zoom()));
        if let Err(failure) = self.destination.write(&name, &self.live.picture()) {
            note(&format!("not saved: {failure}"));
        }
    }

    /// Draws if something has changed, and shows it.
    fn draw(&mut self, window: &mut Window) -> Result<(), Failure> {
        let size = window.get_size();
        let begun = Instant::now();
        self.paint().map_err(gone)?;
        self.shown.longest_wait = self.shown.longest_wait.max(begun.elapsed());
        let Shown { picture: Some(picture), buffer, size: before, .. } = &mut self.shown else {
            return Ok(());
        };
        if *before != size {
            *before = size;
            lay_out(picture, size, buffer);
        }
        // Every time: what another window has covered is not kept.
        window
            .update_with_buffer(buffer, size.0, size.1)
            .map_err(|error| Failure::Runtime(format!("the window cannot be drawn on: {error}")))?;
        self.title(window);
        Ok(())
    }

    /// Gets the picture of now; a draft, if it takes long. What was shown before stays until there is either.
    fn paint(&mut self) -> Result<(), Gone> {
        if self.shown.whole_of == self.changes {
            return Ok(());
        }
        let finished = self.painter.finished(Duration::ZERO)?;
        self.take(finished);
        if self.shown.whole_of != self.changes && self.painter.begin(self.changes, &self.live, 1)? {
            let finished = self.painter.finished(PATIENCE)?;
            self.take(finished);
        }
        let draft = self.drafter.finished(Duration::ZERO)?;
        self.take_draft(draft);
        let is_wanted = self.shown.whole_of != self.changes && self.shown.drafted != self.changes;
        let divisor = if self.shown.took < LONG { 2 } else { 4 };
        if is_wanted && self.drafter.begin(self.changes, &self.live, divisor)? {
            self.shown.drafted = self.changes;
        }
        Ok(())
    }

    /// Shows a whole picture if it is that of now.
    fn take(&mut self, painted: Option<Painted>) {
        let Some(Painted { number, picture: Some(picture), took }) = painted else {
            return;
        };
        let shown = &mut self.shown;
        (shown.took, shown.slowest, shown.count) = (took, shown.slowest.max(took), shown.count + 1);
        if number == self.changes {
            shown.show(self.live.shown(picture.clone()), number);
            (shown.whole, shown.whole_of) = (Some(picture), number);
        }
    }

    /// Shows a draft if nothing newer is shown: while something moves it may always be a little late.
    fn take_draft(&mut self, painted: Option<Painted>) {
        if let Some(Painted { number, picture: Some(draft), .. }) = painted
            && number > self.shown.picture_of
            && self.live.zoom().is_none()
        {
            self.shown.show(draft, number);
        }
    }

    fn title(&mut self, window: &mut Window) {
        let under = self.pointer.and_then(|shown| {
            let pixel = self.live.pixel_at(shown)?;
            Some(format!(" · {}", Live::told(pixel, self.shown.whole.as_ref()?.get(pixel.0, pixel.1)?)))
        });
        let took = self.shown.took.as_secs_f64() * 1e3;
        let drawing = if self.shown.whole_of == self.changes { "" } else { " · drawing" };
        let title = format!("{}{drawing} · {took:.1} ms{}", self.live.status(), under.unwrap_or_default());
        if title != self.shown.title {
            window.set_title(&title);
            self.shown.title = title;
        }
    }
}

/// The picture in the middle of a window, each pixel as a square of whole pixels.
fn lay_out(picture: &Framebuffer, (width, height): (usize, usize), buffer: &mut Vec<u32>) {
    let layout = Layout::new((width, height), picture);
    buffer.clear();
    buffer.resize(width * height, BORDER);
    if buffer.is_empty() {
        return;
    }
    let word =
        |color: Color| color.channels().iter().fold(0, |word, channel| word << 8 | u32::from(*channel));
    for (y, row) in (0..).zip(buffer.chunks_exact_mut(width)) {
        for (x, place) in (0..).zip(row) {
            let (column, line) = layout.pixel((x, y));
            if let Some(color) = picture.get(column, line) {
                *place = word(color);
            }
        }
    }
}

fn digit(key: Key) -> Option<usize> {
    const DIGITS: [Key; 9] =
        [Key::Key1, Key::Key2, Key::Key3, Key::Key4, Key::Key5, Key::Key6, Key::Key7, Key::Key8, Key::Key9];
    DIGITS.iter().position(|digit| *digit == key).map(|place| place + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_lies_in_the_middle_at_a_whole_number_scale() {
        let mut picture = Framebuffer::new(3, 2);
        picture.set(0, 0, Color::RED);
        let mut buffer = Vec::new();
        lay_out(&picture, (11, 5), &mut buffer);
        let red: Vec<usize> = (0..55).filter(|i| buffer[*i] == 0xff_00_00).collect();
        // Scale 2, from column 2 on and row 0 on: the lower left pixel is at rows 2 and 3.
        assert_eq!(red, [24, 25, 35, 36]);
        assert_eq!(buffer.iter().filter(|word| **word == BORDER).count(), 55 - 24);
        let layout = Layout::new((11, 5), &picture);
        assert_eq!(
            (layout.pixel((2, 3)), layout.pixel((7, 0)), layout.pixel((1, 0))),
            ((0, 0), (2, 1), (-1, 1))
        );
        // Too large for the window: its middle.
        lay_out(&picture, (1, 2), &mut buffer);
        assert_eq!(buffer, [0, 0]);
    }
}
