//! The promise: two bands of static memory, one sent by DMA while the other is drawn, show the bytes of a frame that is drawn at
//! once, in about the time of the slower of drawing and sending, and not in the sum of both.
//!
//! Time is virtual: a bus takes so many cycles a byte, and drawing what [`CLEAR`] and [`PIXEL`] say of what is counted.

#[path = "common/bus.rs"]
mod bus;
use crate::common;

use std::cell::Cell;
use std::convert::Infallible;
use std::marker::PhantomData;

use bus::{Bus, Channel, Clock, bytes, memory, words};
use common::for_all;
use common::scenes::{Draw, Maker, Surfaces, meshes, of_materials, scene};
use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::*;
use fixel::material::Kind;
use fixel::{
    Background, Band, BigEndian, Camera, Changes, Coloring, Cull, Depth16, DisplayList, Inputs, ListMemory,
    Material, Mesh, NoDepth, PixelFormat, Pose, QuarterPixel, Shader, Surface, TargetError, Texture, Turn,
    Varying, Vec3, Vertex,
};
use proptest::prelude::*;

/// Cycles that a word of pixels and of depth takes to clear.
const CLEAR: u64 = 3;
/// … that a pixel of a triangle takes: of a wide textured floor with depth on a Cortex-M0+, as the page `cost` has it, with its
/// share of a row.
const PIXEL: u64 = 35;

/// A material whose pixels take their time.
#[derive(Debug)]
struct Timed<K> {
    material: Material<'static, K>,
    clock: Clock,
}

impl<F: PixelFormat, K: Kind> Shader<F> for Timed<K> {
    type Quality = QuarterPixel;

    fn inputs(&self) -> Inputs {
        Shader::<F>::inputs(&self.material)
    }

    fn color(&self, varying: &Varying) -> F::Word {
        self.clock.pass(PIXEL);
        Shader::<F>::color(&self.material, varying)
    }

    fn cull(&self) -> Cull {
        Shader::<F>::cull(&self.material)
    }

    fn coloring(&self) -> Coloring {
        Shader::<F>::coloring(&self.material)
    }

    fn texture_scale(&self) -> u32 {
        Shader::<F>::texture_scale(&self.material)
    }
}

type Memory = ListMemory<2000, 1000>;
type List<'a> = DisplayList<'a, BigEndian<Rgb565>, Depth16, 16>;
type TimedBand = Band<'static, BigEndian<Rgb565>, Depth16>;

/// A screen in bands of one height.
#[derive(Clone, Copy, Debug)]
struct Screen {
    width: u32,
    rows: u32,
    bands: u32,
}

impl Screen {
    fn size(self) -> Size {
        Size::new(self.width, self.rows * self.bands)
    }

    fn words(self) -> usize {
        (self.width * self.rows) as usize
    }

    fn band(self) -> TimedBand {
        let (pixels, depth) = (memory(self.words()), memory(self.words()));
        Band::new(Size::new(self.width, self.rows), pixels, depth).expect("the memory is of this size")
    }
}

const SKY: Rgb565 = Rgb565::new(3, 20, 9);

/// A sky that takes its time.
struct TimedSky<'a>(&'a Clock);

impl Background<BigEndian<Rgb565>> for TimedSky<'_> {
    fn fill_row(&self, y: u32, row: &mut [u16]) {
        self.0.pass(CLEAR * row.len() as u64);
        Background::<BigEndian<Rgb565>>::fill_row(&SKY, y, row);
    }
}

/// What some frames took, and what the display shows in the end.
#[derive(Debug)]
struct Run {
    /// Cycles until all was sent.
    total: u64,
    /// Cycles that each band took to be drawn.
    draws: Vec<u64>,
    shown: Vec<u8>,
}

impl Run {
    fn draw(&self) -> u64 {
        self.draws.iter().sum()
    }
}

/// Each band is drawn, then sent, and drawn to again.
fn with_one_band(screen: Screen, frames: u32, list: &List<'_>, mut bus: Bus) -> Run {
    let clock = bus.clock.clone();
    let start = clock.now();
    let (mut band, mut draws) = (screen.band(), Vec::new());
    for number in (0..frames).flat_map(|_| 0..screen.bands) {
        let before = clock.now();
        band.move_to(number * screen.rows);
        band.clear_to(&TimedSky(&clock));
        list.render(number * screen.rows, &mut band);
        draws.push(clock.now() - before);
        let (area, size) = (band.bounding_box(), band.size());
        let (pixels, depth) = band.into_slices();
        let (idle, sent) = bus.send(area, bytes(pixels)).wait();
        bus = idle;
        band = Band::new(size, words(sent), depth).expect("the memory is the same");
    }
    Run { total: clock.now() - start, draws, shown: bus.shown }
}

/// Each band is drawn while the one before is sent.
fn with_two_bands(screen: Screen, frames: u32, list: &mut List<'_>, bus: Bus) -> Run {
    let clock = bus.clock.clone();
    let start = clock.now();
    let (mut band, mut draws) = (screen.band(), Vec::new());
    let mut channel = Some(Channel::Idle(bus, memory(screen.words())));
    let mut before = start;
    for _ in 0..frames {
        let Ok(()) = list.render_bands(screen.size().height, &TimedSky(&clock), &mut band, |_, band| {
            draws.push(clock.now() - before);
            channel = channel.take().map(|channel| channel.send(band));
            before = clock.now();
            Ok::<_, Infallible>(())
        });
    }
    let (bus, _) = channel.expect("it is always there").wait();
    Run { total: clock.now() - start, draws, shown: bus.shown }
}

/// When all is sent, if a band is drawn as soon as the band before is drawn and its memory sent, and sent as soon as it is drawn
/// and the bus free.
fn expected_of_two(draws: &[u64], send: u64) -> u64 {
    let (mut drawn, mut sent) = (0, [0, 0]);
    for draw in draws {
        drawn = sent[0].max(drawn) + draw;
        sent = [sent[1], sent[1].max(drawn) + send];
    }
    sent[1]
}

/// The words of a frame that is drawn at once, without any of this.
fn at_once(screen: Screen, surfaces: &Surfaces<Rgb565, Depth16>, draws: &[Draw]) -> Vec<u16> {
    let size = screen.size();
    let area = (size.width * size.height) as usize;
    let (mut pixels, mut depth) = (vec![0; area], vec![0; area]);
    let mut band = Band::<Rgb565, Depth16>::new(size, &mut pixels, &mut depth).expect("it fits");
    band.clear_to(&SKY);
    for draw in draws {
        draw.draw(size, surfaces, &mut band);
    }
    pixels
}

#[test]
fn the_display_shows_what_is_drawn_at_once() {
    let drawn = Cell::new(0_u64);
    let screens =
        (1..70_u32, 1..12_u32, 1..7_u32).prop_map(|(width, rows, bands)| Screen { width, rows, bands });
    for_all("DMA", 150, (screens, scene(6), 1..400_u64), |(screen, draws, cycles_a_byte)| {
        let clock = Clock::default();
        let surfaces = all_timed(&clock);
        let mut memory = Memory::new();
        let mut list = List::new(&mut memory);
        for draw in &draws {
            draw.draw(screen.size(), &surfaces, &mut list).expect("it is large");
        }
        let picture: Vec<u8> = at_once(screen, &all_timed(&Clock::default()), &draws)
            .into_iter()
            .flat_map(u16::to_be_bytes)
            .collect();
        let bus = || Bus::new(screen.size(), &clock, cycles_a_byte);
        let send = cycles_a_byte * 2 * screen.words() as u64;
        let one = with_one_band(screen, 2, &list, bus());
        let two = with_two_bands(screen, 2, &mut list, bus());
        for run in [&one, &two] {
            prop_assert_eq!(&run.shown, &picture);
        }
        prop_assert_eq!(one.total, one.draw() + 2 * u64::from(screen.bands) * send);
        prop_assert_eq!(two.total, expected_of_two(&two.draws, send));
        drawn.set(drawn.get() + list.lengths()[1] as u64);
        Ok(())
    });
    assert!(drawn.get() > 1000, "the scenes are empty");
}

const UPRIGHT: Screen = Screen { width: 240, rows: 16, bands: 20 };

fn timed<F: PixelFormat>(
    material: Material<'static, impl Kind>,
    clock: &Clock,
) -> Surface<'static, F, Depth16> {
    Surface::new(Box::leak(Box::new(Timed { material, clock: clock.clone() })))
}

/// Makes surfaces whose pixels take their time.
struct InTime<'a, F>(&'a Clock, PhantomData<F>);

impl<F: PixelFormat> Maker for InTime<'_, F> {
    type Made = Surface<'static, F, Depth16>;

    fn make<K: Kind>(&self, material: Material<'static, K>) -> Self::Made {
        timed(material, self.0)
    }
}

fn all_timed<F: PixelFormat>(clock: &Clock) -> Surfaces<F, Depth16> {
    of_materials(&InTime(clock, PhantomData))
}

/// All of the screen, with the same work in every row: a checkered wall that is one triangle.
fn wall(list: &mut List<'_>, camera: &Camera, clock: &Clock) {
    static CHECKS: Texture = Texture::new(&[0xffdf, 0x4a69, 0x4a69, 0xffdf], 1, 1);
    const WALL: Mesh = Mesh::new(
        &[
            Vertex::new(-7.0, -2.5, 0.0).uv(0, 64),
            Vertex::new(7.0, -2.5, 0.0).uv(64, 64),
            Vertex::new(0.0, 6.0, 0.0).uv(32, 0),
        ],
        &[[0, 1, 2]],
    );
    let checks = timed(Material::textured(&CHECKS), clock);
    camera.draw(&WALL, &Pose::IDENTITY, checks, list).expect("it is large");
}

/// Much work in the middle of the screen, and none above and below.
fn torus(list: &mut List<'_>, camera: &Camera, clock: &Clock) {
    let pose = Pose::IDENTITY.rotated_x(Turn::from_degrees(50)).at(Vec3::lit(0.0, 0.0, -1.0));
    camera.draw(&meshes()[0], &pose, timed(Material::gouraud(), clock), list).expect("it is large");
}

/// The cycles of so many frames: drawing them, sending them, both with one band, both with two, and the longest that a band took.
fn times(list: &mut List<'_>, clock: &Clock, frames: u32, cycles_a_byte: u64) -> [u64; 5] {
    let bus = || Bus::new(UPRIGHT.size(), clock, cycles_a_byte);
    let one = with_one_band(UPRIGHT, frames, list, bus());
    let two = with_two_bands(UPRIGHT, frames, list, bus());
    let band = cycles_a_byte * 2 * UPRIGHT.words() as u64;
    let send = band * u64::from(frames * UPRIGHT.bands);
    let longest = band.max(two.draws.iter().copied().max().unwrap_or(0));
    let times = [two.draw(), send, one.total, two.total, longest];
    println!("{cycles_a_byte} cycles a byte: {:?}", times.map(|cycles| cycles / 1000));
    times
}

#[test]
fn frames_take_as_long_as_the_slower_of_drawing_and_sending() {
    let clock = Clock::default();
    let camera = Camera::perspective(Turn::from_degrees(60), UPRIGHT.size()).at(Vec3::lit(0.0, 0.0, 3.0));

    println!("a wall: thousands of cycles of draw, send, one band, two bands, longest band");
    let mut memory = Memory::new();
    let mut list = List::new(&mut memory);
    wall(&mut list, &camera, &clock);
    // At 125 MHz a bus of 62.5 MHz takes 16 cycles a byte.
    for cycles_a_byte in [8, 16, 19, 40] {
        for frames in [1, 4] {
            let [draw, send, one, two, longest] = times(&mut list, &clock, frames, cycles_a_byte);
            match cycles_a_byte {
                8 => assert!(draw > 2 * send, "it is not bound by drawing"),
                19 => assert!(draw.abs_diff(send) * 50 < draw, "it is not balanced"),
                40 => assert!(send > 2 * draw, "it is not bound by the bus"),
                _ => {}
            }
            assert_eq!(one, draw + send);
            // Beside the first band nothing is sent, and beside the last nothing drawn.
            let slower = draw.max(send);
            assert!(two > slower && two <= slower + longest, "{two} cycles, {slower} of the slower");
        }
    }

    println!("a torus");
    let mut memory = Memory::new();
    let mut list = List::new(&mut memory);
    torus(&mut list, &camera, &clock);
    for cycles_a_byte in [4, 8, 16] {
        let [draw, send, one, two, _] = times(&mut list, &clock, 4, cycles_a_byte);
        assert_eq!(one, draw + send);
        // Empty bands are quickly drawn and full ones quickly sent: two bands cannot even out more than two.
        let (saved, ideal) = (one - two, draw.min(send));
        assert!(saved * 2 > ideal, "{saved} cycles saved of {ideal}");
    }
}

/// Bands in which nothing changed are not sent, and the others as they are.
#[test]
fn only_bands_with_changes_are_sent() {
    let clock = Clock::default();
    let screen = Screen { width: 48, rows: 4, bands: 10 };
    let camera = Camera::focal(24.0, screen.size());
    let gold = timed(Material::gouraud(), &clock);
    let mut band = screen.band();
    let mut changes = Changes::<10>::new();
    let mut channel = Some(Channel::Idle(Bus::new(screen.size(), &clock, 1), memory(screen.words())));
    let mut memory = Memory::new();
    let mut list = List::new(&mut memory);
    let mut send = |list: &List<'_>| {
        let result = list.render_changed(
            screen.size().height,
            &TimedSky(&clock),
            &mut band,
            &mut changes,
            |_, band| {
                channel = channel.take().map(|channel| channel.send(band));
                Ok::<_, Infallible>(())
            },
        );
        let Ok(flushed) = result;
        let (bus, free) = channel.take().expect("it is always there").wait();
        let seen = (flushed.bands, bus.sent, bus.shown.clone());
        channel = Some(Channel::Idle(Bus { sent: 0, ..bus }, free));
        seen
    };
    for (frame, x) in [0.0, 0.2, 0.4].into_iter().enumerate() {
        list.clear();
        let pose = Pose::IDENTITY.scaled_lit(0.3).at(Vec3::lit(x, 0.0, -2.0));
        camera.draw(&meshes()[2], &pose, gold, &mut list).expect("it is large");
        let (bands, sent, shown) = send(&list);
        assert!(if frame == 0 { bands == 10 } else { (1..5).contains(&bands) }, "{bands} bands");
        assert_eq!(sent, bands as usize * 2 * screen.words());
        let whole = with_one_band(screen, 1, &list, Bus::new(screen.size(), &clock, 1));
        assert!(shown == whole.shown, "frame {frame}");
    }
}

#[test]
fn pixels_are_swapped_and_nothing_else() {
    // As a channel wants them that moves words of 4 bytes.
    #[repr(align(4))]
    struct Aligned([u16; 60]);
    let mut other: &'static mut [u16] = &mut Box::leak(Box::new(Aligned([7; 60]))).0;
    let mut band = Band::<BigEndian<Rgb565>, Depth16>::new(Size::new(10, 6), memory(60), memory(60))
        .expect("it fits")
        .starting_at(30);
    band.clear_to(&Rgb565::RED);
    band.swap_pixels(&mut other).expect("it is as large");
    assert!(
        other.iter().all(|word| *word == 0xf800_u16.to_be()) && band.pixels().iter().all(|word| *word == 7)
    );
    assert_eq!((band.size(), band.bounding_box().top_left.y), (Size::new(10, 6), 30));

    let mut small = memory(59);
    let too_few = TargetError::Pixels { needed: 60, found: 59 };
    assert_eq!(band.swap_pixels(&mut small), Err(too_few));
    assert_eq!((small.len(), band.pixels().len()), (59, 60));

    let mut large = memory(100);
    band.swap_pixels(&mut large).expect("it is larger");
    assert_eq!((large.len(), band.pixels().len()), (60, 60));
    let wide: Result<&mut [u32], _> = bytemuck::try_cast_slice_mut(large);
    assert_eq!(wide.map(|words| words.len()), Ok(30));
}

#[test]
fn below_the_last_full_band_there_is_a_part_and_then_all_of_it_again() {
    let screen = Screen { width: 6, rows: 4, bands: 1 };
    let mut of_list = Memory::new();
    let (mut band, mut list) = (screen.band(), List::new(&mut of_list));
    let mut other = memory(24);
    for fails in [false, true] {
        let mut rows = Vec::new();
        let result = list.render_bands(11, &SKY, &mut band, |area, band| {
            assert_eq!(band.bounding_box(), area);
            assert_eq!(
                (band.pixels().len(), band.depth().len()),
                (band.as_bytes().len() / 2, band.colors().len())
            );
            assert_eq!(band.pixels().len() as u32, 6 * area.size.height);
            band.swap_pixels(&mut other).expect("both are of one size");
            assert_eq!(other.len(), 24, "all of the memory is given away");
            rows.push(area.size.height);
            if fails && rows.len() == 3 { Err("busy") } else { Ok(()) }
        });
        assert_eq!((&rows[..], result.is_err()), (&[4, 4, 3][..], fails));
        assert_eq!((band.size(), band.pixels().len()), (Size::new(6, 4), 24));
    }
}

#[test]
fn without_depth_no_memory_is_asked_for() {
    let size = Size::new(10, 6);
    let mut band = Band::<Rgb565, NoDepth>::new(size, memory(60), &mut []).expect("it fits");
    band.clear_to(&SKY);
    const TRIANGLE: Mesh = Mesh::new(
        &[Vertex::new(-2.0, -2.0, 0.0), Vertex::new(2.0, -2.0, 0.0), Vertex::new(0.0, 2.0, 0.0)],
        &[[0, 1, 2]],
    );
    let white = Material::gouraud();
    let mut memory = ListMemory::<4, 2>::new();
    let mut list = DisplayList::<Rgb565, NoDepth, 1>::new(&mut memory);
    let camera = Camera::focal(6.0, size).at(Vec3::lit(0.0, 0.0, 3.0));
    camera.draw(&TRIANGLE, &Pose::IDENTITY, &white, &mut list).expect("it fits");
    list.render(0, &mut band);
    let drawn = band.pixels().iter().filter(|word| **word == 0xffff).count();
    assert!(drawn > 10, "{drawn} pixels");
    let mut none = [(); 60];
    let mut pixels = [0; 60];
    let mut given = Band::<Rgb565, NoDepth>::new(size, &mut pixels, &mut none).expect("it fits");
    given.clear_to(&SKY);
    list.render(0, &mut given);
    assert_eq!(given.pixels(), band.pixels());
}
