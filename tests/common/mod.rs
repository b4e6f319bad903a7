//! What the tests share: how many cases to run, formats that record what the pipeline did to each pixel, and the way
//! from the reference's plain integers to the crate's types and back.

#![allow(clippy::float_arithmetic, reason = "only the crate is to do without")]

pub(crate) mod decoded;
pub(crate) mod generate;
pub(crate) mod perspective;
pub(crate) mod scenes;
pub(crate) mod view;

use std::fmt::{Debug, Formatter};
use std::marker::PhantomData;

use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::Size;
use fixel::fixed::types::{I12F4, I16F16, U1F31, U8F8};
use fixel::{
    Band, Cull, DepthFormat, Inputs, PixelFormat, Quality, RangeError, ScreenVertex, Shader, Surface, Varying,
};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, Reason, RngAlgorithm, TestCaseError, TestRng, TestRunner};

use crate::reference::{ATTRIBUTES, Corner, Facing, Triangle};

/// `usual` cases, times the environment variable `FIXEL_CASES`.
pub(crate) fn cases(usual: u32) -> u32 {
    let factor = std::env::var("FIXEL_CASES").map_or(1.0, |text| {
        text.parse::<f64>().expect("FIXEL_CASES is a number: how many times the usual number of cases to run")
    });
    ((f64::from(usual) * factor) as u32).max(1)
}

/// Holds `check` against `usual` × `FIXEL_CASES` values of a strategy, the same ones in every run unless
/// `FIXEL_SEED` is set, and panics with the smallest failing value found.
pub(crate) fn for_all<S: Strategy>(
    name: &str,
    usual: u32,
    strategy: S,
    check: impl Fn(S::Value) -> Result<(), TestCaseError>,
) where
    S::Value: Debug,
{
    let check = &check;
    let any = AnyStrategy(&|runner| Ok(Box::new(Checked { part: strategy.new_tree(runner)?, check })));
    run(name, cases(usual), &any);
}

fn run(name: &str, cases: u32, strategy: &AnyStrategy<'_>) {
    let config = Config { cases, failure_persistence: None, max_shrink_iters: 20_000, ..Config::default() };
    let number =
        std::env::var("FIXEL_SEED").map_or(0, |text| text.parse::<u64>().expect("FIXEL_SEED is a number"));
    // A seed of its own for each name: FNV-1a.
    let hash = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let named = name.bytes().fold(0xcbf2_9ce4_8422_2325, hash);
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&number.to_le_bytes());
    seed[8..16].copy_from_slice(&named.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    if let Err(failure) = TestRunner::new_with_rng(config, rng).run(strategy, |case| case.0.check()) {
        panic!("{name}: {failure}");
    }
    println!("{name}: {cases} cases");
}

/// A strategy of any type, with the check of its values: proptest's runner is compiled once for all tests, not once for each.
struct AnyStrategy<'a>(&'a dyn Fn(&mut TestRunner) -> Result<Tree<'a>, Reason>);

type Tree<'a> = Box<dyn ValueTree<Value = Case<'a>> + 'a>;

impl Debug for AnyStrategy<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str("AnyStrategy")
    }
}

impl<'a> Strategy for AnyStrategy<'a> {
    type Tree = Tree<'a>;
    type Value = Case<'a>;

    fn new_tree(&self, runner: &mut TestRunner) -> Result<Tree<'a>, Reason> {
        (self.0)(runner)
    }
}

/// A value of any type, that is shown as it is, with its check.
struct Case<'a>(Box<dyn Check + 'a>);

trait Check {
    fn check(self: Box<Self>) -> Result<(), TestCaseError>;
    fn show(&self, f: &mut Formatter<'_>) -> std::fmt::Result;
}

impl Debug for Case<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        self.0.show(f)
    }
}

/// A value, or the tree of values it shrinks along, and the check.
struct Checked<'a, T, C> {
    part: T,
    check: &'a C,
}

impl<T: Debug, C: Fn(T) -> Result<(), TestCaseError>> Check for Checked<'_, T, C> {
    fn check(self: Box<Self>) -> Result<(), TestCaseError> {
        (self.check)(self.part)
    }

    fn show(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        self.part.fmt(f)
    }
}

impl<'a, T, C> ValueTree for Checked<'a, T, C>
where
    T: ValueTree<Value: 'a>,
    C: Fn(T::Value) -> Result<(), TestCaseError>,
{
    type Value = Case<'a>;

    fn current(&self) -> Case<'a> {
        Case(Box::new(Checked { part: self.part.current(), check: self.check }))
    }

    fn simplify(&mut self) -> bool {
        self.part.simplify()
    }

    fn complicate(&mut self) -> bool {
        self.part.complicate()
    }
}

/// What a shader was asked to draw into a pixel: the last attributes, and how often.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Drawn {
    /// In units of 2⁻¹⁶: u, v, red, green, blue.
    pub(crate) attributes: [i32; ATTRIBUTES],
    /// Whether it was written at all.
    pub(crate) written: bool,
}

/// A pixel format whose word keeps a pixel's attributes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Recording {}

impl PixelFormat for Recording {
    type Word = Drawn;
    type Color = Rgb565;

    fn encode(_: Rgb565) -> Drawn {
        Drawn { written: true, ..Drawn::default() }
    }

    fn decode(_: Drawn) -> Rgb565 {
        Rgb565::default()
    }

    // A texel comes back as it is: its word stands for u.
    fn rgb565(word: u16) -> Drawn {
        Drawn { attributes: [word.into(), 0, 0, 0, 0], written: true }
    }

    fn rgb888(r: u8, g: u8, b: u8) -> Drawn {
        Drawn { attributes: [0, 0, r.into(), g.into(), b.into()], written: true }
    }
}

/// What the depth test met at a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Met {
    /// How many times it was asked.
    pub(crate) times: u32,
    /// The last q it was asked with, in units of 2⁻³¹.
    pub(crate) q: u32,
    /// Whether nothing may be drawn here, as if behind something else.
    pub(crate) hidden: bool,
}

/// A depth format that counts, and lets everything pass where nothing is hidden.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Counting {}

impl DepthFormat for Counting {
    type Word = Met;
    const CLEAR: Met = Met { times: 0, q: 0, hidden: false };

    fn test(stored: &Met, _: U1F31) -> bool {
        !stored.hidden
    }

    fn store(_: &mut Met, _: U1F31) {}

    fn test_and_store(stored: &mut Met, z: U1F31) -> bool {
        *stored = Met { times: stored.times + 1, q: z.to_bits(), ..*stored };
        Self::test(stored, z)
    }
}

/// A shader that writes down the attributes it gets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recorder<Q> {
    inputs: Inputs,
    quality: PhantomData<fn() -> Q>,
}

impl<Q> Recorder<Q> {
    pub(crate) const fn new(inputs: Inputs) -> Self {
        Self { inputs, quality: PhantomData }
    }
}

impl<Q: Quality> Shader<Recording> for Recorder<Q> {
    type Quality = Q;

    fn inputs(&self) -> Inputs {
        self.inputs
    }

    fn color(&self, varying: &Varying) -> Drawn {
        let [r, g, b] = varying.color;
        Drawn { attributes: [varying.u, varying.v, r, g, b].map(I16F16::to_bits), written: true }
    }
}

/// A strip of a screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Strip {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// The first row of it.
    pub(crate) row: u32,
}

impl Strip {
    pub(crate) const fn new(width: u32, height: u32, row: u32) -> Self {
        Self { width, height, row }
    }

    pub(crate) const fn size(&self) -> Size {
        Size::new(self.width, self.height)
    }

    pub(crate) const fn len(&self) -> usize {
        (self.width * self.height) as usize
    }

    /// Every pixel (x, y), in the order of memory.
    pub(crate) fn pixels(self) -> impl Iterator<Item = (i32, i32)> {
        let rows = self.row..self.row + self.height;
        rows.flat_map(move |y| (0..self.width).map(move |x| (x as i32, y as i32)))
    }
}

/// The words of a strip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Canvas<P, D> {
    pub(crate) strip: Strip,
    pub(crate) pixels: Vec<P>,
    pub(crate) depth: Vec<D>,
}

impl<P: Clone + Default, D: Clone> Canvas<P, D> {
    /// A canvas of zeros with the depth cleared.
    pub(crate) fn new<F>(strip: Strip) -> Self
    where
        F: DepthFormat<Word = D>,
    {
        Self { strip, pixels: vec![P::default(); strip.len()], depth: vec![F::CLEAR; strip.len()] }
    }

    /// Draws one triangle into it.
    pub(crate) fn draw<'a, F, G, S>(
        &mut self,
        triangle: &Triangle,
        cull: Cull,
        surface: S,
    ) -> Result<(), RangeError>
    where
        F: PixelFormat<Word = P>,
        G: DepthFormat<Word = D>,
        S: Into<Surface<'a, F, G>>,
    {
        let mut band = Band::<F, G>::new(self.strip.size(), &mut self.pixels, &mut self.depth)
            .expect("the sizes agree")
            .starting_at(self.strip.row);
        fixel::draw_triangle(&triangle.0.map(screen_vertex), cull, surface, &mut band)
    }
}

/// What one recording pass over a strip leaves.
pub(crate) type Record = Canvas<Drawn, Met>;

impl Record {
    pub(crate) fn blank(strip: Strip) -> Self {
        Self::new::<Counting>(strip)
    }

    /// Hides pixels by a pattern of 64 bits, so that spans come in pieces.
    pub(crate) fn hide(&mut self, pattern: u64) {
        for (index, met) in self.depth.iter_mut().enumerate() {
            met.hidden = pattern >> (index % 64) & 1 != 0;
        }
    }

    /// Draws a triangle that is within the guard band.
    pub(crate) fn record<Q: Quality>(&mut self, triangle: &Triangle, cull: Cull, inputs: Inputs) {
        self.draw::<Recording, Counting, _>(triangle, cull, Surface::new(&Recorder::<Q>::new(inputs)))
            .expect("the triangle is within range");
    }

    /// (x, y), what was drawn there, what the depth test met.
    pub(crate) fn iter(&self) -> impl Iterator<Item = ((i32, i32), Drawn, Met)> {
        let words = self.pixels.iter().copied().zip(self.depth.iter().copied());
        self.strip.pixels().zip(words).map(|(place, (drawn, met))| (place, drawn, met))
    }
}

/// The crate's vertex for a plain one. A colour's unit there is 1/256: its last 8 bits here are dropped.
pub(crate) fn screen_vertex(corner: Corner) -> ScreenVertex {
    let [u, v, r, g, b] = corner.attributes;
    ScreenVertex {
        x: I12F4::from_bits(i16::try_from(corner.x).expect("x in an i16")),
        y: I12F4::from_bits(i16::try_from(corner.y).expect("y in an i16")),
        q: U1F31::from_bits(corner.q),
        u: I16F16::from_bits(u),
        v: I16F16::from_bits(v),
        color: [r, g, b]
            .map(|channel| U8F8::from_bits(u16::try_from(channel >> 8).expect("a colour of 0 to 255"))),
    }
}

/// Whether a triangle that faces this way is drawn.
pub(crate) fn survives(facing: Facing, cull: Cull) -> bool {
    match cull {
        Cull::None => facing != Facing::Edge,
        Cull::Back => facing == Facing::Front,
        Cull::Front => facing == Facing::Back,
    }
}
