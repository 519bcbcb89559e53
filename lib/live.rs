//! Beside the renderer: a figure that is turned and looked at.
//!
//! Events change what is looked at, and a pure function of it draws. No window, no terminal and no page is known here:
//! they translate their keys and buttons into [`Event`]s, and show the [`Live::picture`].
//!
//! ```text
//!   keys, mouse ── Event ──▶ Live ── picture() ──▶ pixels
//!                             │
//!                             └──── history(pixel), status() ──▶ words
//! ```

use glam::{DVec2, dvec2};

use crate::color::Color;
use crate::figure::picture::{Zoom, difference, fill_blocks};
use crate::figure::{Animation, Chapter, Fit, Given, Knob, Mistake, RasterizerChoice, Scene, Value, Variant};
use crate::files::FileError;
use crate::framebuffer::Framebuffer;
use crate::inspect::{History, history, overdraw};
use crate::rect::{Pixel, Rect};

/// What somebody does. Pixels are those of the picture that is shown, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// Shows the variant of this place in the chapter's table; nothing happens if there is none.
    Variant(usize),
    /// Shows the variant so many places further on, round and round.
    NextVariant(i32),
    /// Takes hold of the knob so many places further on, round and round.
    NextKnob(i32),
    /// Turns the knob that is held by so many steps.
    Turn(i32),
    /// Sets the knob of this place in the variant's table to a value of its kind; nothing happens if there is none.
    Set(usize, Value),
    /// Shows a frame of an animation; beyond the last, the last.
    Frame(u32),
    /// Draws in another size, in pixels.
    Resize((u32, u32)),
    /// Sets all knobs to their defaults, shows the first frame, and magnifies nothing.
    Reset,
    /// Shows another view, or the variant itself if that view is shown already.
    Show(View),
    /// Lets the animation run, or the knob that is held where there is none; or stops what runs.
    Run,
    /// Lets the knob that is held go to and fro through its range; or stops what runs.
    Sweep,
    /// Shows one step more of what runs: to be sent [`Live::rate`] times a second.
    Tick,
    /// Draws with the next rasterizer, where there is a choice.
    NextRasterizer,
    /// Draws with a rasterizer, where there is a choice.
    Rasterizer(RasterizerChoice),
    /// Magnifies by so many notches of a wheel around a pixel, or the reverse.
    Magnify(i32, Pixel),
    /// A button goes down at a pixel: takes hold of a point nearby, or of a model.
    Press(Pixel),
    /// The pointer moves to a pixel while the button is down.
    Drag(Pixel),
    /// The button goes up.
    Release,
}

/// What is shown of a variant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// The variant itself.
    #[default]
    Itself,
    /// The remedy of a mistake, its knobs at the same values.
    Remedy,
    /// Where the two differ.
    Difference,
    /// How often each pixel was written.
    Overdraw,
}

/// What a button holds while it is down.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Held {
    /// A point, by its index among the knobs, and how far from the pointer it is.
    Point(usize, DVec2),
    /// The model: where the pointer was.
    Model(Pixel),
    /// Nothing that can be moved.
    Nothing,
}

/// What moves by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Motion {
    Frames,
    /// A knob on its way, so many steps after the beginning of its range.
    Sweep(u32),
}

/// Degrees that the eye goes round when a model is dragged by a pixel.
const DEGREES_PER_PIXEL: f64 = 0.5;
/// Magnifications, one a notch.
const FACTORS: [u32; 11] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64];

/// A figure, and how it is looked at.
#[derive(Clone, Debug)]
pub struct Live<'a> {
    chapter: &'a Chapter,
    given: Given,
    scene: Scene<'a>,
    view: View,
    knob: usize,
    motion: Option<Motion>,
    magnification: usize,
    center: Pixel,
    held: Option<Held>,
}

impl<'a> Live<'a> {
    /// Looks at a scene of a chapter; `given` is what other variants draw in place of their own models.
    #[must_use]
    pub fn new(chapter: &'a Chapter, scene: Scene<'a>, given: Given) -> Self {
        let (view, knob, motion, magnification, center, held) = (View::Itself, 0, None, 0, (0, 0), None);
        Self { chapter, given, scene, view, knob, motion, magnification, center, held }
    }

    /// What is looked at.
    #[must_use]
    pub const fn scene(&self) -> &Scene<'a> {
        &self.scene
    }

    /// What is shown of it.
    #[must_use]
    pub const fn view(&self) -> View {
        self.view
    }

    /// The knob that is held, and its value.
    #[must_use]
    pub fn knob(&self) -> Option<(&'static Knob, Value)> {
        self.scene.knobs.iter().nth(self.knob)
    }

    /// Whether the button is down.
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// Takes hold of the knob of a name, if there is one.
    pub fn take_knob(&mut self, name: &str) {
        if let Some(index) = self.scene.variant.knobs.iter().position(|knob| knob.name == name) {
            self.take(index);
        }
    }

    /// Takes hold of a knob; the one that was on its way stops.
    fn take(&mut self, index: usize) {
        self.knob = index;
        self.motion = self.motion.filter(|motion| *motion == Motion::Frames);
    }

    /// How often in a second something moves by itself; `None` if nothing does.
    #[must_use]
    pub fn rate(&self) -> Option<u32> {
        match self.motion? {
            Motion::Frames => self.scene.variant.animation.map(|animation| animation.rate),
            Motion::Sweep(_) => Some(Animation::SWEEP.rate),
        }
    }

    /// The variant that is the remedy of the one that is looked at.
    #[must_use]
    pub fn remedy(&self) -> Option<&'a Variant> {
        match self.scene.variant.mistake {
            Mistake::RemediedBy(name) => self.chapter.find(name),
            Mistake::No | Mistake::WithoutRemedy => None,
        }
    }

    /// Does what an event says. Gives whether the picture may have changed.
    ///
    /// # Errors
    /// If a variant's own model is not in `assets/`.
    pub fn apply(&mut self, event: Event) -> Result<bool, FileError> {
        match event {
            Event::Variant(index) => return self.look_at(index),
            Event::NextVariant(places) => {
                let count = self.chapter.variants.len();
                return self.look_at(moved(self.place(), places, count));
            }
            Event::NextKnob(places) => {
                self.take(moved(self.knob, places, self.scene.variant.knobs.len()));
                return Ok(false);
            }
            Event::Turn(steps) => self.turn(steps),
            Event::Set(index, value) => self.set(index, value),
            Event::Frame(frame) => self.scene.frame = frame.min(self.frames() - 1),
            Event::Resize(size) => self.scene.size = size,
            Event::Reset => self.reset(),
            Event::Show(view) => self.show(view),
            Event::Run if self.scene.variant.animation.is_some() => self.run(Motion::Frames),
            Event::Run | Event::Sweep => self.run(Motion::Sweep(0)),
            Event::Tick => self.tick(),
            Event::NextRasterizer => self.next_rasterizer(),
            Event::Rasterizer(choice) => self.draw_with(choice),
            Event::Magnify(notches, pixel) => self.magnify(notches, pixel),
            Event::Press(pixel) => self.press(pixel),
            Event::Drag(pixel) => return Ok(self.drag(pixel)),
            Event::Release => self.held = None,
        }
        Ok(!matches!(event, Event::Press(_) | Event::Release))
    }

    /// Where the variant stands in the chapter's table.
    fn place(&self) -> usize {
        self.chapter.variants.iter().position(|variant| variant.name == self.scene.variant.name).unwrap_or(0)
    }

    /// Looks at another variant; knobs that it has too keep their values, and so does a size that was asked for.
    fn look_at(&mut self, index: usize) -> Result<bool, FileError> {
        let Some(variant) = self.chapter.variants.get(index) else {
            return Ok(false);
        };
        let (before, knob) = (self.scene.variant, self.knob().map(|(knob, _)| knob.name));
        let mut scene = Scene::new(variant, &self.given)?;
        scene.knobs.take_over(&self.scene.knobs);
        if self.scene.size != before.size {
            scene.size = self.scene.size;
        }
        *self = Self::new(self.chapter, scene, std::mem::take(&mut self.given));
        self.take_knob(knob.unwrap_or_default());
        Ok(true)
    }

    /// The knob is held then, so that it is the one that runs.
    fn set(&mut self, index: usize, value: Value) {
        if let Some(knob) = self.scene.variant.knobs.get(index) {
            self.take(index);
            self.scene.knobs.put(knob.name, value);
        }
    }

    /// How many frames there are; 1 of one picture.
    fn frames(&self) -> u32 {
        self.scene.variant.animation.map_or(1, |animation| animation.frames)
    }

    fn turn(&mut self, steps: i32) {
        if let Some((knob, value)) = self.knob() {
            self.scene.knobs.put(knob.name, knob.stepped(value, steps));
        }
    }

    fn reset(&mut self) {
        for knob in self.scene.variant.knobs {
            self.scene.knobs.put(knob.name, knob.default());
        }
        (self.scene.frame, self.magnification, self.motion) = (0, 0, None);
    }

    fn show(&mut self, view: View) {
        let needs_remedy = matches!(view, View::Remedy | View::Difference);
        self.view =
            if self.view == view || (needs_remedy && self.remedy().is_none()) { View::Itself } else { view };
    }

    fn run(&mut self, motion: Motion) {
        let can_run = motion == Motion::Frames || self.knob().is_some_and(|(knob, _)| knob.at(0.0).is_some());
        self.motion = (self.motion.is_none() && can_run).then_some(motion);
    }

    fn tick(&mut self) {
        match self.motion {
            Some(Motion::Frames) => {
                self.scene.frame = (self.scene.frame + 1) % self.frames();
            }
            Some(Motion::Sweep(step)) => {
                // There and back again.
                let last = Animation::SWEEP.frames;
                let fraction = f64::from(last - step.abs_diff(last)) / f64::from(last);
                let swept = self.knob().and_then(|(knob, _)| Some((knob, knob.at(fraction)?)));
                if let Some((knob, value)) = swept {
                    self.scene.knobs.put(knob.name, value);
                }
                self.motion = Some(Motion::Sweep((step + 1) % (2 * last)));
            }
            None => {}
        }
    }

    fn next_rasterizer(&mut self) {
        let all = RasterizerChoice::ALL;
        let place = all.iter().position(|choice| *choice == self.scene.rasterizer).unwrap_or(0);
        self.draw_with(all[moved(place, 1, all.len())]);
    }

    fn draw_with(&mut self, choice: RasterizerChoice) {
        if self.scene.variant.rasterizer.is_some() {
            self.scene.rasterizer = choice;
        }
    }

    /// What is under the pointer stays there.
    fn magnify(&mut self, notches: i32, pointer: Pixel) {
        let Some(pixel) = self.pixel_at(pointer) else {
            return;
        };
        let last = FACTORS.len() as i32 - 1;
        self.magnification = (self.magnification as i32).saturating_add(notches).clamp(0, last) as usize;
        let (part, factor) = self.part();
        let center =
            |pixel: i32, pointer: i32, count: usize| pixel - pointer / factor as i32 + count as i32 / 2;
        self.center =
            (center(pixel.0, pointer.0, part.columns().len()), center(pixel.1, pointer.1, part.rows().len()));
    }

    fn press(&mut self, pixel: Pixel) {
        let Some(pixel) = self.pixel_at(pixel) else {
            self.held = Some(Held::Nothing);
            return;
        };
        let place = self.in_scene(pixel);
        let offset = |value: Value| match value {
            Value::Point(point) => Some(point - place),
            _ => None,
        };
        let points = self.scene.knobs.iter().enumerate();
        let near = points.filter_map(|(index, (_, value))| Some((index, offset(value)?)));
        let nearest = near.min_by(|(_, a), (_, b)| a.length().total_cmp(&b.length()));
        let reach = f64::from(self.scene.variant.size.0) / 20.0;
        self.held = Some(match nearest {
            Some((index, offset)) if offset.length() <= reach => {
                self.take(index);
                Held::Point(index, offset)
            }
            _ if self.scene.knobs.find("azimuth").is_some() => {
                self.take_knob("azimuth");
                Held::Model(pixel)
            }
            _ => Held::Nothing,
        });
    }

    /// Moves what is held, as far as the border. Gives whether anything is.
    fn drag(&mut self, (x, y): Pixel) -> bool {
        let (width, height) = self.scene.size;
        let Some(pixel) = self.pixel_at((x.clamp(0, width as i32 - 1), y.clamp(0, height as i32 - 1))) else {
            return false;
        };
        match self.held {
            Some(Held::Point(index, offset)) => {
                let name = self.scene.variant.knobs[index].name;
                self.scene.knobs.put(name, Value::Point(self.in_scene(pixel) + offset));
                true
            }
            Some(Held::Model(from)) => {
                let by = dvec2(f64::from(pixel.0 - from.0), f64::from(pixel.1 - from.1)) * DEGREES_PER_PIXEL;
                // The model follows the pointer, so the eye goes the other way.
                self.orbit("azimuth", -by.x, true);
                self.orbit("elevation", -by.y, false);
                self.held = Some(Held::Model(pixel));
                true
            }
            Some(Held::Nothing) | None => false,
        }
    }

    /// Turns an angle by so many degrees; round and round, or to the end of its range.
    fn orbit(&mut self, name: &str, degrees: f64, round: bool) {
        let angle = self.scene.knobs.iter().find(|(knob, _)| knob.name == name);
        if let Some((knob, Value::Number(angle))) = angle {
            let turned = angle + degrees;
            let turned = if round { (turned + 180.0).rem_euclid(360.0) - 180.0 } else { turned };
            let (low, high) = (knob.at(0.0), knob.at(1.0));
            if let (Some(Value::Number(low)), Some(Value::Number(high))) = (low, high) {
                self.scene.knobs.put(name, Value::Number(turned.clamp(low, high)));
            }
        }
    }

    /// A pixel of the scene's picture as a point of its variant's own size.
    fn in_scene(&self, (x, y): Pixel) -> DVec2 {
        let point = dvec2(f64::from(x), f64::from(y));
        if self.scene.variant.in_pixels {
            return point;
        }
        let (width, height) = self.scene.variant.size;
        Fit::new(self.whole(), [width.into(), height.into()]).back(point)
    }

    const fn whole(&self) -> Rect {
        Rect::sized(self.scene.size.0, self.scene.size.1)
    }

    /// The part of the picture that is shown, and how large its pixels are.
    fn part(&self) -> (Rect, u32) {
        let factor = FACTORS[self.magnification];
        let (width, height) = self.scene.size;
        // At the upper and the right border pixels may be cut.
        let room = (width + factor - 1, height + factor - 1);
        (Zoom { factor, center: Some(self.center) }.part_within(self.whole(), room), factor)
    }

    /// How the part that is shown is magnified, if it is.
    #[must_use]
    pub fn zoom(&self) -> Option<Zoom> {
        let factor = FACTORS[self.magnification];
        (factor > 1).then_some(Zoom { factor, center: Some(self.center) })
    }

    /// Which pixel of the scene's picture a pixel of the picture that is shown belongs to; `None` outside of it.
    #[must_use]
    pub fn pixel_at(&self, (x, y): Pixel) -> Option<Pixel> {
        let (part, factor) = self.part();
        let pixel = (part.left + x.div_euclid(factor as i32), part.bottom + y.div_euclid(factor as i32));
        part.contains(pixel.0, pixel.1).then_some(pixel)
    }

    /// The scene that is the remedy: the same knobs, size, frame and rasterizer.
    fn remedied(&self) -> Option<Scene<'a>> {
        let mut scene = Scene::new(self.remedy()?, &self.given).ok()?;
        scene.knobs.take_over(&self.scene.knobs);
        let Scene { frame, size, rasterizer, .. } = self.scene;
        Some(Scene { frame, size, rasterizer, ..scene })
    }

    /// The whole picture, not magnified.
    #[must_use]
    pub fn whole_picture(&self) -> Framebuffer {
        match self.view {
            View::Itself => self.scene.draw(),
            View::Overdraw => overdraw(self.scene.variant, &self.scene.options(None)).0,
            View::Remedy => self.remedied().map_or_else(|| self.scene.draw(), |remedied| remedied.draw()),
            View::Difference => {
                let this = self.scene.draw();
                let marked = self.remedied().and_then(|remedied| difference(&this, &remedied.draw()));
                marked.map_or(this, |(marked, _)| marked)
            }
        }
    }

    /// A draft of the picture in about 1 / `divisor`² of the time: it is drawn with sides so many times shorter, and its pixels are
    /// enlarged. `None` where single pixels are what the variant is about, or what is looked at.
    #[must_use]
    pub fn draft(&self, divisor: u32) -> Option<Framebuffer> {
        if self.scene.variant.in_pixels || self.magnification > 0 {
            return None;
        }
        let (width, height) = self.scene.size;
        let scene = Scene { size: (width.div_ceil(divisor), height.div_ceil(divisor)), ..self.scene.clone() };
        let small = Self { scene, ..self.clone() }.whole_picture();
        let mut draft = Framebuffer::new(width, height);
        fill_blocks(&mut draft, &small, small.rect(), divisor);
        Some(draft)
    }

    /// What is shown of the whole picture: all of it, or a part with large pixels and a grid, in the same size.
    #[must_use]
    pub fn shown(&self, whole: Framebuffer) -> Framebuffer {
        match self.part() {
            (_, 1) => whole,
            (part, factor) => {
                let mut shown = Framebuffer::new(whole.width(), whole.height());
                fill_blocks(&mut shown, &whole, part, factor);
                shown
            }
        }
    }

    /// What is shown.
    #[must_use]
    pub fn picture(&self) -> Framebuffer {
        self.shown(self.whole_picture())
    }

    /// All that happened at a pixel of the scene's picture; of the remedy's, if that is shown.
    #[must_use]
    pub fn history(&self, pixel: Pixel) -> History {
        let remedied = self.remedied().filter(|_| self.view == View::Remedy);
        let scene = remedied.as_ref().unwrap_or(&self.scene);
        history(self.chapter.name, scene.variant, &scene.options(None), pixel).without_misses()
    }

    /// What is shown, in a line: `affine · tilt = 30 · 4×`.
    #[must_use]
    pub fn status(&self) -> String {
        let mut parts = vec![match (self.view, self.remedy()) {
            (View::Remedy, Some(remedy)) => format!("{}: remedy of {}", remedy.name, self.scene.variant.name),
            (View::Difference, Some(remedy)) => {
                format!("{} | {}: difference", self.scene.variant.name, remedy.name)
            }
            (View::Overdraw, _) => format!("{}: overdraw", self.scene.variant.name),
            _ => self.scene.variant.name.to_owned(),
        }];
        parts.extend(self.knob().map(|(knob, value)| format!("{} = {}", knob.name, knob.shown(value))));
        if self.scene.variant.animation.is_some() {
            parts.push(format!("frame {}", self.scene.frame));
        }
        if self.scene.variant.rasterizer.is_some() {
            parts.push(self.scene.rasterizer.name().to_owned());
        }
        if self.magnification > 0 {
            parts.push(format!("{}×", FACTORS[self.magnification]));
        }
        parts.join(" · ")
    }

    /// The command that draws what is shown, not magnified: `cargo run --bin ch05_perspective_correct -- affine --set tilt=60`.
    #[must_use]
    pub fn command(&self) -> String {
        let remedied = self.remedied().filter(|_| self.view == View::Remedy);
        let Scene { variant, ref knobs, frame, size, rasterizer, .. } =
            *remedied.as_ref().unwrap_or(&self.scene);
        let mut words = vec![format!("cargo run --bin {} -- {}", self.chapter.name, variant.name)];
        words.extend(knobs.changed().iter().map(|setting| format!("--set {setting}")));
        if frame > 0 {
            words.push(format!("--frame {frame}"));
        }
        if size != variant.size {
            words.push(format!("--size {}x{}", size.0, size.1));
        }
        if variant.rasterizer.is_some_and(|own| own != rasterizer) {
            words.push(format!("--rasterizer {}", rasterizer.name()));
        }
        match self.view {
            View::Difference => words.push("--compare".to_owned()),
            View::Overdraw => words.push("--overdraw".to_owned()),
            View::Itself | View::Remedy => {}
        }
        words.join(" ")
    }

    /// A pixel in words: `(60, 120) #00ff00`.
    #[must_use]
    pub fn told((x, y): Pixel, color: Color) -> String {
        let [red, green, blue] = color.channels();
        format!("({x}, {y}) #{red:02x}{green:02x}{blue:02x}")
    }
}

/// A place so many places further on, round and round.
fn moved(place: usize, places: i32, count: usize) -> usize {
    (place as i64 + i64::from(places)).rem_euclid(count.max(1) as i64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::{Canvas, Knobs};

    const KNOBS: &[Knob] =
        &[Knob::number("level", 100.0, [0.0, 240.0], "", "-"), Knob::point("dot", [4.0, 6.0], "-")];

    /// A gray picture with a white dot; that of the mistake is one pixel too far to the right.
    fn dot(picture: &mut Framebuffer, knobs: &Knobs, shift: i32) {
        picture.clear(Color::gray(knobs.number("level") as u8));
        let at = Fit::new(picture.rect(), [40.0, 30.0]).at(knobs.point("dot"));
        picture.set(at.x as i32 + shift, at.y as i32, Color::WHITE);
    }

    fn right(picture: &mut Framebuffer, knobs: &Knobs) {
        dot(picture, knobs, 0);
    }

    fn wrong(picture: &mut Framebuffer, knobs: &Knobs) {
        dot(picture, knobs, 1);
    }

    fn moving(canvas: &mut Canvas) {
        let level = 10 * canvas.frame as u8 + canvas.knobs.whole("more") as u8;
        canvas.picture_mut().clear(Color::gray(level));
    }

    const CHAPTER: Chapter = Chapter {
        name: "ch00",
        question: "?",
        variants: &[
            Variant::with_knobs("wrong", wrong, KNOBS, "-").size(40, 30).remedied_by("right"),
            Variant::with_knobs("right", right, KNOBS, "-").size(40, 30),
            Variant::with_pipeline("moving", moving, "-")
                .size(8, 8)
                .animated(Animation { frames: 3, rate: 7 })
                .remedied_by("turned")
                .knobs(&[Knob::whole("more", 0, [0, 1], "", "-")]),
            Variant::with_pipeline("turned", |_| {}, "-").size(40, 30).knobs(&[
                Knob::number("azimuth", 170.0, [-180.0, 180.0], "°", "-"),
                Knob::number("elevation", 80.0, [-89.0, 89.0], "°", "-"),
            ]),
        ],
    };

    fn live() -> Live<'static> {
        let scene = Scene::new(CHAPTER.lead(), &Given::default()).expect("no model");
        Live::new(&CHAPTER, scene, Given::default())
    }

    fn play<'a>(mut live: Live<'a>, events: &[Event]) -> Live<'a> {
        for event in events {
            live.apply(*event).expect("no model");
        }
        live
    }

    #[test]
    fn a_draft_has_large_pixels_and_the_same_size() {
        let draft = live().draft(4).expect("nothing is magnified");
        assert_eq!((draft.width(), draft.height()), (40, 30));
        let (level, dot) = seen(&draft);
        // (4, 6) is (1, 1) of 10 × 8 pixels, and the mistake's one is one farther to the right.
        assert_eq!((level, dot), (100, Some((8, 4))));
        assert_eq!(draft.get(11, 7), Some(Color::WHITE), "a pixel of four by four");
        assert!(play(live(), &[Event::Magnify(1, (5, 6))]).draft(4).is_none(), "single pixels are looked at");
    }

    /// The level of gray, and where the white dot is.
    fn seen(picture: &Framebuffer) -> (u8, Option<Pixel>) {
        let rect = picture.rect();
        let mut pixels = rect.pixels();
        let dot = pixels.find(|&(x, y)| picture.get(x, y) == Some(Color::WHITE));
        let level = picture.get(rect.right - 1, rect.top - 1).unwrap_or_default().channels()[0];
        (level, dot)
    }

    #[test]
    fn knobs_turn_and_come_back() {
        let turned = play(live(), &[Event::Turn(10), Event::NextKnob(1), Event::Turn(3)]);
        assert_eq!(seen(&turned.picture()), (120, Some((8, 6))));
        assert_eq!(turned.status(), "wrong · dot = 7,6");
        assert_eq!(seen(&play(turned, &[Event::Reset]).picture()), (100, Some((5, 6))));
        let far = play(live(), &[Event::Turn(-1000)]);
        assert_eq!(seen(&far.picture()).0, 0, "the end of the range");
        assert_eq!(play(live(), &[Event::NextKnob(-1)]).knob().expect("a knob").0.name, "dot");
    }

    #[test]
    fn what_is_set_is_shown_and_named_as_a_command() {
        let set = [Event::Set(0, Value::Number(7.0)), Event::Set(9, Value::Number(1.0))];
        let set = play(live(), &set);
        assert_eq!(seen(&set.picture()), (7, Some((5, 6))));
        assert_eq!(set.command(), "cargo run --bin ch00 -- wrong --set level=7");
        let compared = play(set, &[Event::Show(View::Difference)]);
        assert_eq!(compared.command(), "cargo run --bin ch00 -- wrong --set level=7 --compare");
        let remedied = play(compared, &[Event::Show(View::Remedy), Event::Resize((80, 60))]);
        assert_eq!(remedied.command(), "cargo run --bin ch00 -- right --set level=7 --size 80x60");
        let (choice, frame) = (Event::Rasterizer(RasterizerChoice::Exact), Event::Frame(2));
        let framed = play(live(), &[Event::Variant(2), choice, frame, Event::Show(View::Overdraw)]);
        assert_eq!(
            framed.command(),
            "cargo run --bin ch00 -- moving --frame 2 --rasterizer exact --overdraw"
        );
        let all = [Event::Variant(2), choice, frame, Event::Resize((9, 9)), Event::Show(View::Remedy)];
        let all = play(live(), &all).command();
        assert_eq!(all, "cargo run --bin ch00 -- turned --frame 2 --size 9x9 --rasterizer exact");
        assert_eq!(play(live(), &[Event::Variant(2), Event::Frame(9)]).scene().frame, 2, "the last one");
        assert_eq!(play(live(), &[Event::Frame(9)]).scene().frame, 0, "it has no frames");
        assert_eq!(play(live(), &[choice]).command(), "cargo run --bin ch00 -- wrong", "it has no choice");
    }

    #[test]
    fn a_point_is_dragged_and_stays_in_the_picture() {
        // It was taken one pixel beside it, and stays beside the pointer.
        let events = [Event::Press((5, 7)), Event::Drag((20, 10)), Event::Release, Event::Drag((1, 1))];
        assert_eq!(seen(&play(live(), &events).picture()).1, Some((20, 9)));
        let out = play(live(), &[Event::Press((4, 6)), Event::Drag((500, -9))]);
        assert_eq!(out.scene.knobs.point("dot"), dvec2(39.0, 0.0), "as far as the border");
        let out = play(out, &[Event::Drag((-9, 500))]);
        assert_eq!(out.scene.knobs.point("dot"), dvec2(0.0, 29.0), "and the other one");
        let missed = [Event::Press((30, 20)), Event::Drag((20, 10))];
        assert_eq!(seen(&play(live(), &missed).picture()).1, Some((5, 6)), "nothing was near");
        // At twice the size a pixel is half a unit of the scene.
        let mut large = live();
        large.scene.size = (80, 60);
        let dragged = play(large, &[Event::Press((8, 12)), Event::Drag((41, 20))]);
        assert_eq!(dragged.scene.knobs.point("dot"), dvec2(20.5, 10.0));
    }

    #[test]
    fn a_model_is_turned_by_the_pointer() {
        let angles = |events: &[Event]| {
            let turned = play(play(live(), &[Event::Variant(3), Event::Press((20, 15))]), events);
            (turned.is_held(), ["azimuth", "elevation"].map(|name| turned.scene.knobs.number(name)))
        };
        // Half a degree a pixel, and the eye goes the other way: round and round, but up no farther than its range.
        assert_eq!(angles(&[Event::Drag((22, 16))]), (true, [169.0, 79.5]));
        assert_eq!(angles(&[Event::Drag((0, 0))]), (true, [180.0 - 360.0, 87.5]));
        assert_eq!(angles(&[Event::Drag((0, 15)), Event::Press((39, 15)), Event::Drag((0, 0))]).1[0], -160.5);
        assert_eq!(
            angles(&[Event::Drag((20, 0)), Event::Release, Event::Drag((0, 29))]),
            (false, [170.0, 87.5])
        );
        assert_eq!(angles(&[Event::Drag((20, 0)), Event::Press((20, 29)), Event::Drag((20, 0))]).1[1], 89.0);
    }

    #[test]
    fn a_pixel_is_told_in_words() {
        assert_eq!(Live::told((60, 120), Color::rgb(0, 255, 10)), "(60, 120) #00ff0a");
    }

    #[test]
    fn a_line_says_what_is_shown() {
        let status = |events: &[Event]| play(live(), events).status();
        assert_eq!(status(&[Event::Show(View::Difference)]), "wrong | right: difference · level = 100");
        assert_eq!(status(&[Event::Show(View::Overdraw)]), "wrong: overdraw · level = 100");
        let (frame, choice) = (Event::Frame(2), Event::Rasterizer(RasterizerChoice::Exact));
        assert_eq!(
            status(&[Event::Variant(2), frame, choice, Event::Magnify(3, (0, 0))]),
            "moving · more = 0 · frame 2 · exact · 4×"
        );
    }

    #[test]
    fn an_event_says_whether_the_picture_may_have_changed() {
        let changed = |mut live: Live<'static>, event| live.apply(event).expect("no model");
        for event in [Event::Variant(0), Event::NextVariant(0), Event::Turn(1), Event::Tick, Event::Reset] {
            assert!(changed(live(), event), "{event:?}");
        }
        for event in [Event::Variant(9), Event::NextKnob(1), Event::Press((5, 7)), Event::Release] {
            assert!(!changed(live(), event), "{event:?}");
        }
        let drag = Event::Drag((20, 10));
        assert!(changed(play(live(), &[Event::Press((5, 7))]), drag), "a point");
        assert!(!changed(play(live(), &[Event::Press((30, 20))]), drag), "nothing was near");
        assert!(!changed(live(), drag), "the button is not down");
    }

    #[test]
    fn views_are_the_remedy_the_difference_and_the_overdraw() {
        let shown = |view| play(live(), &[Event::Turn(10), Event::Show(view)]);
        assert_eq!(seen(&shown(View::Remedy).picture()), (120, Some((4, 6))), "with the same knobs");
        assert_eq!(shown(View::Remedy).status(), "right: remedy of wrong · level = 120");
        let marked = shown(View::Difference).picture();
        let magenta = Color::rgb(255, 0, 255);
        assert_eq!((marked.get(4, 6), marked.get(5, 6)), (Some(magenta), Some(magenta)));
        assert_ne!(marked.get(6, 6), Some(magenta));
        assert_ne!(shown(View::Overdraw).picture(), live().picture());
        let history = |view| shown(view).history((4, 6)).to_string();
        assert!(history(View::Remedy).starts_with("ch00 right level=120"), "of what is shown");
        assert!(history(View::Difference).starts_with("ch00 wrong level=120"));
        let twice = play(shown(View::Remedy), &[Event::Show(View::Remedy)]);
        assert_eq!(twice.view(), View::Itself);
        let without = play(live(), &[Event::Variant(1), Event::Show(View::Remedy)]);
        assert_eq!(without.view(), View::Itself, "it has no remedy");
    }

    #[test]
    fn variants_take_over_knobs_and_an_asked_size() {
        let other = play(live(), &[Event::Turn(10), Event::NextVariant(1)]);
        assert_eq!(seen(&other.picture()), (120, Some((4, 6))));
        let held = play(live(), &[Event::NextKnob(1), Event::NextVariant(1)]);
        assert_eq!(held.knob().expect("a knob").0.name, "dot", "it stays in the hand");
        assert_eq!(play(other, &[Event::NextVariant(-3)]).scene().variant.name, "moving");
        assert_eq!(play(live(), &[Event::Variant(7)]).scene().variant.name, "wrong", "there is no eighth");
        let mut large = live();
        large.scene.size = (80, 60);
        assert_eq!(play(large, &[Event::Variant(2)]).scene().size, (80, 60));
    }

    #[test]
    fn what_runs_goes_round() {
        let levels = |events: &[Event]| seen(&play(live(), events).picture()).0;
        let mut events = vec![Event::Variant(2), Event::Run];
        for expected in [10, 20, 0] {
            events.push(Event::Tick);
            assert_eq!(levels(&events), expected);
        }
        assert_eq!(play(live(), &events).rate(), Some(7));
        let reset =
            play(live(), &[&events[..], &[Event::Tick, Event::Magnify(1, (0, 0)), Event::Reset]].concat());
        assert_eq!((reset.scene.frame, reset.rate(), reset.zoom()), (0, None, None));
        events.extend([Event::Run, Event::Tick]);
        assert_eq!(levels(&events), 0, "it stands");

        let swept = |ticks: usize| levels(&[vec![Event::Run], vec![Event::Tick; ticks]].concat());
        assert_eq!([swept(1), swept(31), swept(61), swept(91), swept(121)], [0, 120, 240, 120, 0]);
        assert_eq!(play(live(), &[Event::NextKnob(1), Event::Run]).rate(), None, "a point has no range");
        assert_eq!(play(live(), &[Event::Run, Event::Press((5, 7))]).rate(), None, "a point was taken");
        let of_frames = [Event::Variant(2), Event::Sweep, Event::Tick, Event::Tick];
        assert_eq!(seen(&play(live(), &of_frames).picture()).0, 0, "the knob runs, not the frames");
    }

    #[test]
    fn single_pixels_are_shown_and_found() {
        let near = play(live(), &[Event::Magnify(1, (5, 6)), Event::Magnify(2, (5, 6))]);
        assert_eq!(near.pixel_at((5, 6)), Some((5, 6)), "what is under the pointer stays there");
        assert_eq!(near.zoom().map(|zoom| zoom.factor), Some(4));
        let twice = play(live(), &[Event::Magnify(1, (5, 6))]);
        assert_eq!([29, 30].map(|y| twice.pixel_at((0, y)).is_some()), [true, false], "15 rows of two");
        let nearest = play(live(), &[Event::Magnify(99, (5, 6))]);
        assert_eq!(nearest.zoom().map(|zoom| zoom.factor), Some(Zoom::MAX_FACTOR));
        let picture = near.picture();
        assert_eq!((picture.width(), picture.height()), (40, 30), "4× as large, cut at the upper border");
        let (_, white) = seen(&picture);
        assert_eq!(near.pixel_at(white.expect("in the part that is shown")), Some((5, 6)));
        assert_eq!(near.pixel_at((40, 0)), None);
        let mut wide = live();
        wide.scene.size = (Framebuffer::MAX_SIDE, 1);
        assert_eq!(play(wide, &[Event::Magnify(2, (0, 0))]).picture().width(), Framebuffer::MAX_SIDE);
        let again = play(near, &[Event::Magnify(-99, (0, 0))]);
        assert_eq!(again.picture(), live().picture());
        assert!(live().history((5, 6)).to_string().contains("pixel (5, 6)"));
    }

    #[test]
    fn only_the_pipeline_has_another_rasterizer() {
        let of = |events: &[Event]| play(live(), events).scene.rasterizer;
        assert_eq!(of(&[Event::NextRasterizer]), of(&[]));
        assert_ne!(of(&[Event::Variant(2), Event::NextRasterizer]), of(&[Event::Variant(2)]));
    }
}
