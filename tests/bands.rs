//! The promise: a display list rendered in bands of any height, by one core or two, shows the bytes of a whole frame that is
//! drawn at once; only what changed is sent, and nothing is missed; a full list says so and is as it was.

use crate::common;

use std::cell::Cell;
use std::convert::Infallible;
use std::fmt::Debug;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;

use common::for_all;
use common::scenes::{Draw, LIGHTS, Surfaces, TEXELS, draw, scene, surfaces};
use fixel::embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_4X6};
use fixel::embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use fixel::embedded_graphics::prelude::*;
use fixel::embedded_graphics::primitives::Rectangle;
use fixel::embedded_graphics::text::Text;
use fixel::{
    Affine, Background, Band, BigEndian, Camera, CapacityError, Changes, Coloring, Depth16, DepthFormat,
    DisplayList, Exact, Flushed, Gradient, Inputs, Light, Lights, ListMemory, Material, Mesh, NoDepth,
    Picture, PixelFormat, Pose, Quality, QuarterPixel, Shader, Surface, Texture, Turn, Varying, Vec3, Vertex,
    View,
};
use proptest::prelude::*;
use static_cell::ConstStaticCell;

/// Memory for every scene here.
type Memory = ListMemory<2000, 1000>;
/// A list that holds every scene here.
type Large<'a, F, D> = DisplayList<'a, F, D, 16>;

fn listed<'a, F: PixelFormat, D: DepthFormat>(
    memory: &'a mut Memory,
    screen: Size,
    draws: &[Draw],
    surfaces: &Surfaces<F, D>,
) -> Large<'a, F, D> {
    let mut list = Large::new(memory);
    for draw in draws {
        draw.draw(screen, surfaces, &mut list).expect("the list is large");
    }
    list
}

/// Pixels and depths of the whole screen, drawn at once.
fn at_once<F, D>(
    screen: Size,
    draws: &[Draw],
    surfaces: &Surfaces<F, D>,
    background: &impl Background<F>,
) -> (Vec<F::Word>, Vec<D::Word>)
where
    F: PixelFormat<Word: Default>,
    D: DepthFormat,
{
    let words = (screen.width * screen.height) as usize;
    let (mut pixels, mut depth) = (vec![F::Word::default(); words], vec![D::CLEAR; words]);
    let mut band = Band::<F, D>::new(screen, &mut pixels, &mut depth).expect("the screen is small");
    band.clear_to(background);
    for draw in draws {
        draw.draw(screen, surfaces, &mut band);
    }
    (pixels, depth)
}

/// Pixels and depths of the whole screen, band by band.
fn in_bands<F, D, const N: usize>(
    screen: Size,
    rows: u32,
    list: &mut DisplayList<'_, F, D, N>,
    background: &impl Background<F>,
) -> (Vec<F::Word>, Vec<D::Word>)
where
    F: PixelFormat<Word: Default>,
    D: DepthFormat,
{
    let words = (screen.width * rows) as usize;
    let (mut pixels, mut depth) = (vec![F::Word::default(); words], vec![D::CLEAR; words]);
    let mut band =
        Band::<F, D>::new(Size::new(screen.width, rows), &mut pixels, &mut depth).expect("the band is small");
    let (mut all, mut all_depth, mut next) = (Vec::new(), Vec::new(), 0);
    let Ok(()) = list.render_bands(screen.height, background, &mut band, |area, band| {
        assert_eq!(area, Rectangle::new(Point::new(0, next), Size::new(screen.width, band.size().height)));
        next += area.size.height as i32;
        all.extend_from_slice(band.pixels());
        all_depth.extend_from_slice(band.depth());
        Ok::<_, Infallible>(())
    });
    (all, all_depth)
}

const SKY: Rgb565 = Rgb565::new(3, 20, 9);

fn screen() -> impl Strategy<Value = Size> {
    (1..70_u32, 1..60_u32).prop_map(|(width, height)| Size::new(width, height))
}

fn same_bytes_at_every_height<Q: Quality, F, D>(name: &str, usual: u32)
where
    F: PixelFormat<Word: Default + PartialEq + Debug>,
    D: DepthFormat<Word: PartialEq + Debug>,
    Rgb565: Background<F>,
{
    let surfaces = surfaces::<Q, F, D>();
    let drawn = Cell::new(0_u64);
    for_all(name, usual, (screen(), scene(6), 1..70_u32), |(screen, draws, any)| {
        let whole = at_once(screen, &draws, &surfaces, &SKY);
        let mut memory = Memory::new();
        let mut list = listed(&mut memory, screen, &draws, &surfaces);
        for rows in [1, 2, 7, 16, any, screen.height] {
            prop_assert_eq!(&in_bands(screen, rows, &mut list, &SKY), &whole, "{} rows", rows);
        }
        drawn.set(drawn.get() + list.lengths()[1] as u64);
        Ok(())
    });
    println!("{name}: {} triangles", drawn.get());
    assert!(drawn.get() > u64::from(usual), "the scenes are empty");
}

#[test]
fn every_height_shows_the_bytes_of_a_whole_frame() {
    same_bytes_at_every_height::<QuarterPixel, Rgb565, Depth16>("heights", 400);
    same_bytes_at_every_height::<Exact, BigEndian<Rgb565>, Depth16>("heights, Exact, big-endian", 100);
    same_bytes_at_every_height::<Affine, Rgb565, Depth16>("heights, Affine", 100);
    same_bytes_at_every_height::<QuarterPixel, Rgb565, NoDepth>("heights, no depth", 100);
}

#[test]
fn a_sorted_list_is_the_same_at_every_height() {
    let surfaces = surfaces::<QuarterPixel, Rgb565, NoDepth>();
    let cases = (screen(), scene(6), 1..70_u32);
    for_all("sorted", 200, cases, |(screen, draws, any)| {
        let mut memory = Memory::new();
        let mut list = listed(&mut memory, screen, &draws, &surfaces);
        list.sort_back_to_front();
        let whole = in_bands(screen, screen.height, &mut list, &SKY);
        for rows in [1, 2, 7, 16, any] {
            prop_assert_eq!(&in_bands(screen, rows, &mut list, &SKY), &whole, "{} rows", rows);
        }
        Ok(())
    });
}

#[test]
fn two_threads_show_the_same_picture() {
    let surfaces = surfaces::<QuarterPixel, Rgb565, Depth16>();
    let cases = (screen(), scene(6), prop::sample::select(vec![1_u32, 2, 7, 16, 60]));
    for_all("two threads", 150, cases, |(screen, draws, rows)| {
        let whole = at_once(screen, &draws, &surfaces, &SKY).0;
        let mut memory = Memory::new();
        let list = listed(&mut memory, screen, &draws, &surfaces);
        // Whoever is done takes the next band: the split is as random as the machine's scheduler.
        let next = AtomicU32::new(0);
        let render = || {
            let words = (screen.width * rows) as usize;
            let (mut pixels, mut depth) = (vec![0; words], vec![0; words]);
            let mut done = Vec::new();
            loop {
                let top = next.fetch_add(rows, Ordering::Relaxed);
                if top >= screen.height {
                    return done;
                }
                let size = Size::new(screen.width, rows.min(screen.height - top));
                let mut band = Band::<Rgb565, Depth16>::new(size, &mut pixels, &mut depth)
                    .expect("the band is small")
                    .starting_at(top);
                band.clear_to(&SKY);
                list.render(top, &mut band);
                done.push((top, band.pixels().to_vec()));
            }
        };
        let mut bands = thread::scope(|scope| {
            let other = scope.spawn(render);
            let mut bands = render();
            bands.extend(other.join().expect("no panic"));
            bands
        });
        bands.sort_unstable();
        let picture: Vec<u16> = bands.into_iter().flat_map(|(_, pixels)| pixels).collect();
        prop_assert_eq!(picture, whole);
        Ok(())
    });
}

/// What `Stats` counts of a mesh in a list and in a frame is the same.
#[test]
fn a_list_counts_what_a_frame_counts() {
    let surfaces = surfaces::<QuarterPixel, Rgb565, Depth16>();
    for_all("counts", 300, draw(), |draw| {
        let screen = Size::new(64, 48);
        let (mut pixels, mut depth) = (vec![0; 64 * 48], vec![0; 64 * 48]);
        let mut band = Band::<Rgb565, Depth16>::new(screen, &mut pixels, &mut depth).expect("it fits");
        let mut memory = Memory::new();
        let mut list = Large::new(&mut memory);
        let [mut in_frame, mut in_list] = [fixel::Stats::default(); 2];
        let (camera, mesh) = (draw.camera(screen), &common::scenes::meshes()[draw.mesh]);
        let (view, surface) = (camera.lit_by(&LIGHTS), surfaces[draw.material]);
        view.draw_counted(mesh, &draw.pose, surface, &mut band, &mut in_frame);
        view.draw_counted(mesh, &draw.pose, surface, &mut list, &mut in_list).expect("it fits");
        // Vertices are transformed once; and a triangle that lies between pixel centres is left out sooner.
        prop_assert!(in_list.transformed <= in_frame.transformed.max(mesh.vertices().len() as u32));
        prop_assert_eq!(in_list.drawn + in_list.out_of_sight, in_frame.drawn + in_frame.out_of_sight);
        prop_assert_eq!(in_list.drawn as usize, list.lengths()[1]);
        let alike = |stats: fixel::Stats| fixel::Stats { transformed: 0, drawn: 0, out_of_sight: 0, ..stats };
        prop_assert_eq!(alike(in_list), alike(in_frame));
        Ok(())
    });
}

/// Draws a scene into a list that is too small for some of it: what did not fit is an error, and the list is the one
/// that would have been without it.
fn full<const V: usize, const T: usize, const D: usize>(
    screen: Size,
    draws: &[Draw],
    sorted: u32,
    surfaces: &Surfaces<Rgb565, NoDepth>,
    met: &Cell<[u32; 4]>,
) -> Result<(), TestCaseError> {
    let picture = |list: &DisplayList<'_, Rgb565, NoDepth, D>| {
        let (mut pixels, mut depth) = (vec![0; 64 * 48], vec![(); 64 * 48]);
        let mut band = Band::<Rgb565, NoDepth>::new(screen, &mut pixels, &mut depth).expect("it fits");
        band.clear_to(&SKY);
        list.render(0, &mut band);
        pixels
    };
    let mut memory = ListMemory::<V, T>::new();
    let mut list = DisplayList::new(&mut memory);
    let mut fitted = Vec::new();
    for (i, draw) in draws.iter().enumerate() {
        if sorted >> i & 1 == 1 {
            list.sort_back_to_front();
        }
        let (before, shown) = (list.lengths(), picture(&list));
        let result = draw.draw(screen, surfaces, &mut list);
        let mut counts = met.get();
        match result {
            Ok(()) => {
                counts[0] += 1;
                fitted.push(*draw);
            }
            Err(error) => {
                // Sorted or not.
                prop_assert_eq!(list.lengths(), before);
                prop_assert_eq!(picture(&list), shown);
                // It is told truly.
                let mut memory = Memory::new();
                let mut large = listed(&mut memory, screen, &fitted, surfaces);
                prop_assert_eq!(draw.draw(screen, surfaces, &mut large), Ok(()));
                let [_, triangles, draws] = large.lengths();
                let is_true = match error {
                    CapacityError::Vertices { needed, .. } => needed > V,
                    CapacityError::Triangles { needed, .. } => triangles > T && needed == triangles,
                    CapacityError::Draws { needed, .. } => draws > D && needed == draws,
                };
                prop_assert!(is_true, "{} with {} triangles in {} draws", error, triangles, draws);
                let (kind, capacity) = match error {
                    CapacityError::Vertices { capacity, .. } => (1, capacity),
                    CapacityError::Triangles { capacity, .. } => (2, capacity),
                    CapacityError::Draws { capacity, .. } => (3, capacity),
                };
                prop_assert_eq!(capacity, [0, V, T, D][kind]);
                counts[kind] += 1;
            }
        }
        met.set(counts);
    }
    // Drawn once more, as it was drawn: another draw changes the order back.
    let fits = fitted.first().is_some_and(|draw: &Draw| draw.draw(screen, surfaces, &mut list).is_ok());
    fitted.extend(fitted.first().copied().filter(|_| fits));
    if fits {
        prop_assert_eq!(picture(&list), at_once(screen, &fitted, surfaces, &SKY).0);
    }
    // And it can be used again.
    list.clear();
    prop_assert_eq!(list.lengths(), [0; 3]);
    let again = fitted.first().map_or(Ok(()), |draw| draw.draw(screen, surfaces, &mut list));
    prop_assert_eq!(again, Ok(()));
    let first = &fitted[..fitted.len().min(1)];
    prop_assert_eq!(picture(&list), at_once(screen, first, surfaces, &SKY).0);
    Ok(())
}

#[test]
fn a_full_list_names_the_capacity_and_is_as_it_was() {
    let surfaces = surfaces::<QuarterPixel, Rgb565, NoDepth>();
    let met = Cell::new([0; 4]);
    let cases = (prop::collection::vec(draw(), 1..12), any::<u32>());
    for_all("full lists", 250, cases, |(draws, sorted)| {
        let screen = Size::new(64, 48);
        full::<0, 0, 0>(screen, &draws, sorted, &surfaces, &met)?;
        full::<4, 2, 1>(screen, &draws, sorted, &surfaces, &met)?;
        full::<63, 20, 8>(screen, &draws, sorted, &surfaces, &met)?;
        full::<64, 1000, 8>(screen, &draws, sorted, &surfaces, &met)?;
        full::<90, 60, 8>(screen, &draws, sorted, &surfaces, &met)?;
        full::<1000, 30, 8>(screen, &draws, sorted, &surfaces, &met)?;
        full::<1000, 500, 2>(screen, &draws, sorted, &surfaces, &met)
    });
    println!("fitted, full of vertices, triangles, draws: {:?}", met.get());
    assert!(met.get().iter().all(|&count| count > 100), "{:?}", met.get());
}

/// The room that eight triangles in a row take, drawn twice with two materials.
fn drawn_twice<const V: usize, const T: usize, const D: usize>() -> Result<[usize; 3], CapacityError> {
    const STRIP: [Vertex; 10] = {
        let mut strip = [Vertex::new(0.0, 0.0, 0.0); 10];
        let mut i = 0;
        while i < 10 {
            strip[i] = Vertex::new((i / 2) as f32 - 2.0, (i % 2) as f32, -4.0);
            i += 1;
        }
        strip
    };
    const CORNERS: [[u16; 3]; 8] =
        [[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5], [4, 6, 5], [5, 6, 7], [6, 8, 7], [7, 8, 9]];
    const MESH: Mesh = Mesh::new(&STRIP, &CORNERS);
    let camera = Camera::focal(40.0, Size::new(64, 48));
    let mut memory = ListMemory::<V, T>::new();
    let mut list = DisplayList::<Rgb565, Depth16, D>::new(&mut memory);
    camera.draw(&MESH, &Pose::IDENTITY, &Material::flat(Rgb565::RED), &mut list)?;
    camera.draw(&MESH, &Pose::IDENTITY, &Material::gouraud(), &mut list)?;
    Ok(list.lengths())
}

#[test]
fn what_an_error_says_is_needed_suffices() {
    assert_eq!(drawn_twice::<9, 16, 2>(), Err(CapacityError::Vertices { capacity: 9, needed: 10 }));
    assert_eq!(drawn_twice::<19, 16, 2>(), Err(CapacityError::Vertices { capacity: 19, needed: 20 }));
    assert_eq!(drawn_twice::<20, 3, 2>(), Err(CapacityError::Triangles { capacity: 3, needed: 8 }));
    assert_eq!(drawn_twice::<20, 9, 2>(), Err(CapacityError::Triangles { capacity: 9, needed: 16 }));
    assert_eq!(drawn_twice::<20, 16, 0>(), Err(CapacityError::Draws { capacity: 0, needed: 1 }));
    assert_eq!(drawn_twice::<20, 16, 1>(), Err(CapacityError::Draws { capacity: 1, needed: 2 }));
    assert_eq!(drawn_twice::<20, 16, 2>(), Ok([20, 16, 2]));
    let message = CapacityError::Triangles { capacity: 9, needed: 16 }.to_string();
    assert!(message.contains("9 triangles") && message.contains("16"), "{message}");
}

/// Rings in the light of the view, by a shader of a caller's own.
struct Rings {
    width_log2: u32,
}

impl Shader<Rgb565> for Rings {
    type Quality = QuarterPixel;

    fn inputs(&self) -> Inputs {
        Inputs::UvColor
    }

    fn coloring(&self) -> Coloring {
        Coloring::of([255, 200, 40]).lit()
    }

    fn color(&self, at: &Varying) -> u16 {
        let [u, v] = [at.u, at.v].map(|texels| i64::from(texels.to_num::<i32>()));
        let is_ring = (u * u + v * v) >> self.width_log2 & 1 == 0;
        let [red, green, blue] = at.color.map(|channel| channel.to_num::<u8>());
        if is_ring { Rgb565::rgb888(red, green, blue) } else { Rgb565::rgb888(blue, red, green) }
    }
}

/// Memory that outlives every frame. What is recorded in it may be gone with its frame: lights, shaders and meshes.
#[test]
fn a_list_on_static_memory_mixes_surfaces_and_lights_of_one_frame() {
    static MEMORY: ConstStaticCell<ListMemory<400, 200>> = ConstStaticCell::new(ListMemory::new());
    let memory = MEMORY.take();
    let (screen, texture) = (Size::new(64, 48), Texture::new(&TEXELS, 4, 4));
    let camera = Camera::focal(40.0, screen);
    let mut pictures = Vec::new();
    for frame in 0..4_u8 {
        let lamp = Vec3::lit(f32::from(frame) - 1.5, 0.5, -1.0);
        let lamps = [Light::point(lamp, [250, 200, 90], fixel::num::I16F16::lit("4"))];
        let lights = Lights::new([20, 30, 40], &lamps);
        let view = camera.lit_by(&lights);
        let rings = Rings { width_log2: 9 + u32::from(frame) };
        let exact = Material::textured(&texture).exact();
        let surfaces: [Surface<'_, Rgb565, Depth16>; 4] = [
            (&Material::flat(Rgb565::CSS_TEAL)).into(),
            (&Material::textured(&texture).lit()).into(),
            (&exact).into(),
            Surface::new(&rings),
        ];
        let torus = common::scenes::meshes()[0];
        let poses = [(-0.7, 0.5), (0.7, 0.5), (-0.7, -0.5), (0.7, -0.5)].map(|(x, y)| {
            let turn = Turn::from_degrees(50 + 10 * i32::from(frame));
            Pose::IDENTITY.rotated_x(turn).scaled_lit(0.5).at(Vec3::lit(x, y, -2.5))
        });

        let at_once = |view: View<'_>| {
            let (mut pixels, mut depth) = (vec![0; 64 * 48], vec![0; 64 * 48]);
            let mut band = Band::new(screen, &mut pixels, &mut depth).expect("it fits");
            band.clear_to(&SKY);
            for (pose, surface) in poses.iter().zip(surfaces) {
                view.draw(&torus, pose, surface, &mut band);
            }
            (pixels, depth)
        };
        let whole = at_once(view);
        assert!(whole.0 != at_once(View::of(&camera)).0, "no light is seen");

        let mut list = DisplayList::<Rgb565, Depth16, 4>::new(memory);
        for (pose, surface) in poses.iter().zip(surfaces) {
            view.draw(&torus, pose, surface, &mut list).expect("there is room");
        }
        assert_eq!(list.lengths()[2], 4);
        for rows in [1, 7, 16, 48] {
            assert!(in_bands(screen, rows, &mut list, &SKY) == whole, "{rows} rows");
        }
        pictures.push(whole.0);
    }
    pictures.dedup();
    assert_eq!(pictures.len(), 4, "a frame shows what the one before it showed");
}

#[test]
fn a_list_takes_what_it_says() {
    type Memory = ListMemory<400, 440>;
    type List = DisplayList<'static, Rgb565, Depth16, 4>;
    assert_eq!([Memory::BYTES, List::BYTES], [size_of::<Memory>(), size_of::<List>()]);
    // 16 bytes a vertex, 8 a triangle and 2 for its place in the order; lengths and draws.
    let room = Memory::BYTES + List::BYTES - 400 * 16 - 440 * 10;
    // A draw keeps its material by value, and the fog: 256 bytes with pointers of 64 bits, and fewer on a chip.
    assert!(room <= 4 * 256 + 128, "{room} bytes for 4 draws");
}

#[test]
fn the_last_vertex_of_the_largest_mesh_keeps_its_texture() {
    let mut vertices = vec![Vertex::new(0.0, 0.0, 0.0); 1 << 16];
    let corners = [(-1.0, -1.0, 0, 16), (1.0, -1.0, 16, 16), (0.0, 1.0, 3, 0)];
    for (vertex, (x, y, u, v)) in vertices.iter_mut().rev().zip(corners) {
        *vertex = Vertex::new(x, y, 0.0).uv(u, v).normal(0.0, 0.0, 1.0);
    }
    let triangles = [[65535, 65534, 65533]];
    let mesh = Mesh::try_new(&vertices, &triangles).expect("the indices are in range");
    let surface = surfaces::<QuarterPixel, Rgb565, Depth16>()[4];
    let screen = Size::new(32, 24);
    let camera = Camera::focal(16.0, screen).at(Vec3::lit(0.0, 0.0, 1.5));
    let view = camera.lit_by(&LIGHTS);
    let mut memory = ListMemory::<3, 1>::new();
    let mut list = DisplayList::<Rgb565, Depth16, 1>::new(&mut memory);
    view.draw(&mesh, &Pose::IDENTITY, surface, &mut list).expect("three vertices are named");
    let mut pictures = [[0; 32 * 24]; 2];
    let mut depth = [0; 32 * 24];
    for (picture, is_listed) in pictures.iter_mut().zip([false, true]) {
        depth.fill(0);
        let mut band = Band::<Rgb565, Depth16>::new(screen, picture, &mut depth).expect("it fits");
        if is_listed {
            list.render(0, &mut band);
        } else {
            view.draw(&mesh, &Pose::IDENTITY, surface, &mut band);
        }
    }
    assert!(pictures[0] == pictures[1] && pictures[0].iter().any(|word| *word != 0));
}

/// A display that keeps what it is sent.
struct Display {
    size: Size,
    pixels: Vec<Rgb565>,
    sent: u32,
}

impl Display {
    fn new(size: Size) -> Self {
        // What a display shows when it is switched on is anything.
        let noise = |i: u32| Rgb565::new((i % 31) as u8, (i % 63) as u8, (i % 29) as u8);
        Self { size, pixels: (0..size.width * size.height).map(noise).collect(), sent: 0 }
    }

    fn send(&mut self, area: &Rectangle, colors: impl Iterator<Item = Rgb565>) {
        let mut colors = colors.fuse();
        for point in area.points() {
            let color = colors.next().expect("as many colours as the area has pixels");
            self.pixels[(point.y as u32 * self.size.width) as usize + point.x as usize] = color;
            self.sent += 1;
        }
        assert!(colors.next().is_none(), "more colours than the area has pixels");
    }
}

/// What the bus says at times.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Busy;

/// A frame: what is drawn, the number on top, and what becomes of the bus.
type Frame = (Vec<Draw>, u8, bool);

fn frames() -> impl Strategy<Value = Vec<Frame>> {
    // Some things stay, some come and go.
    (scene(3), prop::collection::vec((scene(2), 0..4_u8, prop::bool::weighted(0.1)), 2..8)).prop_map(
        |(still, frames)| {
            let draws = |moving: Vec<Draw>| still.iter().copied().chain(moving).collect();
            frames.into_iter().map(|(moving, number, fails)| (draws(moving), number, fails)).collect()
        },
    )
}

#[test]
fn sending_only_what_changed_shows_the_same_as_sending_all() {
    let surfaces = surfaces::<QuarterPixel, Rgb565, Depth16>();
    let saved = Cell::new([0_u64; 2]);
    let cases = (screen(), 1..20_u32, frames());
    for_all("changes", 200, cases, |(screen, rows, frames)| {
        let words = (screen.width * rows) as usize;
        let (mut pixels, mut depth) = (vec![0; words], vec![0; words]);
        let mut band = Band::<Rgb565, Depth16>::new(Size::new(screen.width, rows), &mut pixels, &mut depth)
            .expect("the band is small");
        let (mut display, mut whole) = (Display::new(screen), Display::new(screen));
        // Fewer than there are bands, at times.
        let mut changes = Changes::<12>::new();
        let mut shown = u8::MAX;
        let sky = Gradient::new(Rgb888::CSS_SKY_BLUE, Rgb888::CSS_MIDNIGHT_BLUE, screen.height);
        for (draws, number, fails) in frames {
            let mut memory = Memory::new();
            let mut list = listed(&mut memory, screen, &draws, &surfaces);
            let name = ["0", "12", "345", "6789"][usize::from(number)];
            let style = MonoTextStyle::new(&FONT_4X6, Rgb565::WHITE);
            let text = Text::new(name, Point::new(2, 8), style);
            let Ok(()) = list.render_bands(screen.height, &sky, &mut band, |area, band| {
                let Ok(_) = text.draw(band);
                whole.send(&area, band.colors());
                Ok::<_, Infallible>(())
            });
            if number != shown {
                changes.mark(&Rectangle::new(Point::new(2, 0), Size::new(16, 10)));
                shown = number;
            }
            let before = display.sent;
            let mut left = if fails { 2 } else { u32::MAX };
            let result = list.render_changed(screen.height, &sky, &mut band, &mut changes, |area, band| {
                let Ok(_) = text.draw(band);
                left = left.checked_sub(1).ok_or(Busy)?;
                display.send(&area, band.colors_in(&area));
                Ok::<_, Busy>(())
            });
            match result {
                Ok(Flushed { pixels, all_pixels, bands, all_bands }) => {
                    prop_assert_eq!(pixels, display.sent - before);
                    prop_assert_eq!(all_pixels, screen.width * screen.height);
                    prop_assert!(bands <= all_bands && all_bands == screen.height.div_ceil(rows));
                    prop_assert_eq!(&display.pixels, &whole.pixels);
                    let [sent, all] = saved.get();
                    saved.set([sent + u64::from(pixels), all + u64::from(all_pixels)]);
                }
                Err(error) => prop_assert!(fails && error == Busy),
            }
        }
        Ok(())
    });
    let [sent, all] = saved.get();
    println!("changes: {sent} of {all} pixels sent, {} %", sent * 100 / all);
    assert!(sent * 10 < all * 9, "nothing is saved");
}

/// What may happen between frames, and in them.
#[derive(Clone, Debug)]
enum Event {
    /// With the bus failing after so many bands, or not.
    Frame(Vec<Draw>, Option<u32>),
    /// Another band, and another height of the screen.
    Shape(usize, u32),
    Mark(Rectangle),
}

#[test]
fn other_bands_screens_and_marks_leave_nothing_stale() {
    let surfaces = surfaces::<QuarterPixel, Rgb565, NoDepth>();
    let mark = (any::<[i32; 2]>(), any::<[u32; 2]>())
        .prop_map(|([x, y], [w, h])| Event::Mark(Rectangle::new(Point::new(x, y), Size::new(w, h))));
    let event = prop_oneof![
        6 => (scene(2), prop::option::weighted(0.2, 0..5_u32)).prop_map(|(draws, fails)| Event::Frame(draws, fails)),
        2 => (0..3_usize, 0..80_u32).prop_map(|(band, height)| Event::Shape(band, height)),
        1 => mark,
    ];
    let (frames, failed) = (Cell::new(0), Cell::new(0));
    let cases = (1..60_u32, [1..20_u32, 1..80, 0..3], prop::collection::vec(event, 1..20));
    for_all("shapes", 300, cases, |(width, rows, events)| {
        let screen = Size::new(width, 60);
        let mut words = rows.map(|rows| vec![0; (width * rows) as usize]);
        let mut bands = words.iter_mut().zip(rows).map(|(pixels, rows)| {
            Band::<Rgb565, NoDepth>::new(Size::new(width, rows), pixels, &mut []).expect("it fits")
        });
        let mut bands = [0; 3].map(|_| bands.next().expect("there are three"));
        let mut display = Display::new(Size::new(width, 80));
        let mut changes = Changes::<7>::new();
        let (mut band, mut height) = (0, 48);
        for event in events {
            let (draws, fails) = match event {
                Event::Frame(draws, fails) => (draws, fails),
                Event::Shape(other, rows) => {
                    (band, height) = (other, rows);
                    continue;
                }
                Event::Mark(area) => {
                    changes.mark(&area);
                    continue;
                }
            };
            let mut memory = Memory::new();
            let mut list = listed(&mut memory, screen, &draws, &surfaces);
            let mut left = fails.unwrap_or(u32::MAX);
            let result = list.render_changed(height, &SKY, &mut bands[band], &mut changes, |area, band| {
                left = left.checked_sub(1).ok_or(Busy)?;
                display.send(&area, band.colors_in(&area));
                Ok::<_, Busy>(())
            });
            prop_assert_eq!(bands[band].size(), Size::new(width, rows[band]));
            frames.set(frames.get() + 1);
            if result.is_err() || rows[band] == 0 {
                failed.set(failed.get() + 1);
                continue;
            }
            let whole = in_bands(Size::new(width, height), 16, &mut list, &SKY).0;
            let shown = display.pixels.iter().take(whole.len()).map(|color| color.into_storage());
            prop_assert!(shown.eq(whole), "{} rows of {}", rows[band], height);
        }
        Ok(())
    });
    println!("shapes: {} frames, {} not shown", frames.get(), failed.get());
    assert!(failed.get() > 50 && frames.get() > 3 * failed.get());
}

#[test]
fn what_stands_still_behind_a_small_mover_is_not_sent() {
    let surfaces = surfaces::<QuarterPixel, Rgb565, Depth16>();
    let screen = Size::new(64, 48);
    let (mut pixels, mut depth) = (vec![0; 64 * 8], vec![0; 64 * 8]);
    let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 8), &mut pixels, &mut depth).expect("it fits");
    let mut changes = Changes::<6>::default();
    let mut report = |x: f32| {
        let pose = Pose::IDENTITY.scaled_lit(0.25).at(Vec3::lit(x, 0.0, -2.0));
        let ball = Draw { mesh: 2, material: 3, pose, inset: false, orthographic: false };
        let mut memory = Memory::new();
        let list = listed(&mut memory, screen, &[ball], &surfaces);
        let Ok(flushed) =
            list.render_changed(48, &SKY, &mut band, &mut changes, |_, _| Ok::<_, Infallible>(()));
        flushed
    };
    assert_eq!(report(0.0), Flushed { bands: 6, all_bands: 6, pixels: 64 * 48, all_pixels: 64 * 48 });
    let next = report(0.1);
    // A ball of 7 px in the middle, moved by 2 px: two bands of 8 rows.
    assert!(next.bands == 2 && next.pixels <= 12 * 8, "{next:?}");
}

/// Without depth a list is drawn back to front, and what is as far in the order of drawing.
#[test]
fn without_depth_a_list_is_drawn_back_to_front() {
    const FACING: Mesh = Mesh::new(
        &[Vertex::new(-1.0, -1.0, 0.0), Vertex::new(1.0, -1.0, 0.0), Vertex::new(0.0, 1.0, 0.0)],
        &[[0, 1, 2]],
    );
    let colors: Vec<_> = (0..12).map(|i| Material::flat(Rgb565::new(i, 63 - i, 2 * i))).collect();
    let triangle = || ([-12..12_i16, -8..8_i16], 1..5_i16);
    let shown = Cell::new(0_u32);
    for_all("back to front", 300, prop::collection::vec(triangle(), 1..12), |triangles| {
        let screen = Size::new(48, 40);
        let camera = Camera::focal(24.0, screen);
        let pose = |&([x, y], away): &([i16; 2], i16)| {
            let tenths = |n: i16| fixel::fixed::types::I16F16::from_num(n) / 10;
            Pose::IDENTITY.at(Vec3::new(tenths(x), tenths(y), tenths(-10 * away)))
        };
        let mut memory = ListMemory::<64, 32>::new();
        let mut list = DisplayList::<Rgb565, NoDepth, 16>::new(&mut memory);
        for (triangle, material) in triangles.iter().zip(&colors) {
            prop_assert_eq!(camera.draw(&FACING, &pose(triangle), material, &mut list), Ok(()));
        }
        list.sort_back_to_front();
        let mut sorted: Vec<_> = triangles.iter().zip(&colors).collect();
        sorted.sort_by_key(|((_, away), _)| -away); // it is stable
        let mut pixels = [vec![0; 48 * 40], vec![0; 48 * 40]];
        let [of_list, at_once] = &mut pixels;
        list.render(0, &mut Band::<_, NoDepth>::new(screen, of_list, &mut [(); 48 * 40]).expect("it fits"));
        let mut none = [(); 48 * 40];
        let mut band = Band::<Rgb565, NoDepth>::new(screen, at_once, &mut none).expect("it fits");
        for (triangle, material) in sorted {
            camera.draw(&FACING, &pose(triangle), material, &mut band);
        }
        prop_assert_eq!(&pixels[0], &pixels[1]);
        shown.set(shown.get() + pixels[0].iter().filter(|word| **word != 0).count() as u32);
        Ok(())
    });
    assert!(shown.get() > 10_000);
}

#[test]
fn draws_of_a_mesh_count_as_one_whatever_colours_are_seen() {
    // Grey from the front, coloured from behind.
    const CARD: Mesh = Mesh::new(
        &[
            Vertex::new(-1.0, -1.0, 0.0).color(40, 40, 40),
            Vertex::new(1.0, -1.0, 0.0).color(200, 200, 200),
            Vertex::new(0.0, 1.0, 0.0).color(120, 120, 120),
            Vertex::new(-1.0, -1.0, 0.0).color(255, 0, 0),
            Vertex::new(1.0, -1.0, 0.0).color(0, 255, 0),
            Vertex::new(0.0, 1.0, 0.0).color(0, 0, 255),
        ],
        &[[0, 1, 2], [4, 3, 5]],
    );
    let (size, material) = (Size::new(40, 24), Material::gouraud());
    let camera = Camera::perspective(Turn::from_degrees(60), size).at(Vec3::lit(0.0, 0.0, 4.0));
    let front = Pose::IDENTITY.at(Vec3::lit(-1.2, 0.0, 0.0));
    let behind = Pose::IDENTITY.rotated_y(Turn::from_degrees(180)).at(Vec3::lit(1.2, 0.0, 0.0));
    for poses in [[front, behind], [behind, front]] {
        let mut memory = ListMemory::<12, 4>::new();
        let mut list = DisplayList::<Rgb565, Depth16, 1>::new(&mut memory);
        let (mut whole, mut depth) = ([0; 40 * 24], [0; 40 * 24]);
        let mut frame = Band::<Rgb565, Depth16>::new(size, &mut whole, &mut depth).expect("it fits");
        for pose in &poses {
            camera.draw(&CARD, pose, &material, &mut list).expect("one draw, two triangles");
            camera.draw(&CARD, pose, &material, &mut frame);
        }
        assert_eq!(list.lengths(), [6, 2, 1]);
        let (mut pixels, mut depth) = ([0; 40 * 24], [0; 40 * 24]);
        let mut band = Band::<Rgb565, Depth16>::new(size, &mut pixels, &mut depth).expect("it fits");
        list.render(0, &mut band);
        assert!(pixels == whole);
        assert!(whole.iter().any(|&word| word >> 11 != word & 31), "no colour is seen");
    }
}

#[test]
fn backgrounds_fill_rows_of_the_screen() {
    let size = Size::new(20, 6);
    let (mut pixels, mut depth) = (vec![0; 120], vec![7; 120]);
    let mut band =
        Band::<Rgb565, Depth16>::new(size, &mut pixels, &mut depth).expect("it fits").starting_at(30);
    band.clear_to(&Rgb565::RED);
    assert!(band.pixels().iter().all(|word| *word == 0xf800) && band.depth().iter().all(|depth| *depth == 0));

    let texture = Texture::new(&TEXELS, 4, 4);
    band.clear_to(&texture);
    for (i, word) in band.pixels().iter().enumerate() {
        let (x, y) = (i % 20, 30 + i / 20);
        assert_eq!(*word, TEXELS[y % 16 * 16 + x % 16], "column {x}, row {y}");
    }

    // 17 words a row, and 2½ rows below 30.
    let words: Vec<u16> = (1..=32 * 17 + 8).collect();
    band.clear_to(&Picture::new(&words, 17));
    for (i, word) in band.pixels().iter().enumerate() {
        let (x, y) = (i % 20, 30 + i / 20);
        let expected = if x < 17 { words.get(y * 17 + x).copied().unwrap_or(0) } else { 0 };
        assert_eq!(*word, expected, "column {x}, row {y}");
    }

    // In the middle half of both; exact at the ends, and beyond.
    let gradient = Gradient::new(Rgb888::new(0, 255, 8), Rgb888::new(255, 0, 8), 65);
    for (row, expected) in [(0, [0, 255, 8]), (32, [128, 128, 8]), (64, [255, 0, 8]), (900, [255, 0, 8])] {
        band.move_to(row);
        band.clear_to(&gradient);
        let [red, green, blue] = expected;
        assert_eq!(band.pixels()[19], <Rgb565 as PixelFormat>::rgb888(red, green, blue), "row {row}");
    }
    for height in [0, 1, 2, 1023, u32::MAX] {
        band.move_to(1000);
        band.clear_to(&Gradient::new(Rgb888::WHITE, Rgb888::BLACK, height));
    }
}

#[test]
fn parts_of_a_band_are_given_out_by_rows_and_colours() {
    let (mut pixels, mut depth): (Vec<u16>, _) = ((0..60).collect(), [(); 60]);
    let band = Band::<Rgb565, NoDepth>::new(Size::new(10, 6), &mut pixels, &mut depth)
        .expect("it fits")
        .starting_at(4);
    let area = Rectangle::new(Point::new(7, 2), Size::new(9, 4));
    let rows: Vec<Vec<u16>> = band.rows_in(&area).map(<[u16]>::to_vec).collect();
    assert_eq!(rows, [[7, 8, 9], [17, 18, 19]]);
    let colors: Vec<u16> = band.colors_in(&area).map(|color| color.into_storage()).collect();
    assert_eq!(colors, [7, 8, 9, 17, 18, 19]);
    assert_eq!(band.rows_in(&Rectangle::new(Point::new(0, 90), Size::new(9, 4))).count(), 0);
    let (pixels, _) = band.into_slices();
    assert_eq!(pixels.len(), 60);
}

const SQUARE: [Vertex; 4] = [
    Vertex::new(-1.0, 1.0, 0.0),
    Vertex::new(-1.0, -1.0, 0.0),
    Vertex::new(1.0, -1.0, 0.0),
    Vertex::new(1.0, 1.0, 0.0),
];

/// Cameras that see nothing but a square of −1 … 1 turned by a pose, all over the viewport: which is the whole of the largest
/// targets, or ends at their last column and row.
fn cameras_that_a_square_fills() -> Vec<(Size, Camera, Pose)> {
    let mut cases = Vec::new();
    for (width, height) in [(1, 1023), (1023, 1), (1023, 1023), (1023, 40), (3, 1023)] {
        let target = Size::new(width, height);
        // From 512, where the square's own border is hardly beyond the target, to where all sides are far out.
        for pixels in [512.0, 523.0, 600.0, 1500.0, 8000.0] {
            for (left, top) in
                [(0, 0), (width as i32 - 1, height as i32 / 2), (width as i32 / 3, height as i32 - 1)]
            {
                let corner = Point::new(left, top);
                let size = Size::new(width - left as u32, height - top as u32);
                for camera in [Camera::focal(pixels, size), Camera::orthographic(pixels, size)] {
                    let camera = camera.viewport(corner).at(Vec3::lit(0.0, 0.0, 1.0));
                    let upright = Pose::IDENTITY;
                    let turned = upright.rotated_z(Turn::from_degrees(45)).scaled_lit(1.5);
                    cases.push((target, camera, upright));
                    cases.push((target, camera, turned));
                    // Through the near plane, too.
                    if !camera.is_orthographic() {
                        let tilted = upright.rotated_y(Turn::from_degrees(40)).scaled_lit(12.0);
                        cases.push((target, camera.near(0.01), tilted));
                    }
                }
            }
        }
    }
    cases
}

#[test]
fn the_largest_targets_are_filled_up_to_the_last_row_and_column() {
    const MESH: Mesh = Mesh::new(&SQUARE, &[[0, 1, 2], [0, 2, 3]]);
    let white = Material::flat(Rgb565::WHITE);
    let cases = cameras_that_a_square_fills();
    for (target, camera, pose) in &cases {
        let words = (target.width * target.height) as usize;
        let (mut pixels, mut depth) = (vec![0; words], vec![0; words]);
        // Of the viewport all, and nothing around it; by the camera's own word where its middle is.
        let (x, y) = camera.center();
        let first = [x, y].map(|at| f64::from(at.to_bits()) / 16.0);
        let start = [2.0 * first[0] - f64::from(target.width), 2.0 * first[1] - f64::from(target.height)];
        let missing = |top: u32, depth: &[u16]| {
            depth.iter().enumerate().find_map(|(i, depth)| {
                let (column, row) = (i as u32 % target.width, top + i as u32 / target.width);
                let inside = f64::from(column) >= start[0] && f64::from(row) >= start[1];
                (inside != (*depth > 0)).then_some((column, row))
            })
        };
        let mut band = Band::<Rgb565, Depth16>::new(*target, &mut pixels, &mut depth).expect("it fits");
        camera.draw(&MESH, pose, &white, &mut band);
        assert_eq!(missing(0, &depth), None, "at once, {target:?}, {camera:?}, {pose:?}");

        let mut memory = ListMemory::<40, 20>::new();
        let mut list = DisplayList::<Rgb565, Depth16, 1>::new(&mut memory);
        camera.draw(&MESH, pose, &white, &mut list).expect("there is room");
        for rows in [7, 512, 1023] {
            for is_listed in [false, true] {
                let mut top = 0;
                while top < target.height {
                    let rows = rows.min(target.height - top);
                    let words = (target.width * rows) as usize;
                    let (pixels, depth) = (&mut pixels[..words], &mut depth[..words]);
                    depth.fill(0);
                    let size = Size::new(target.width, rows);
                    let mut band =
                        Band::<Rgb565, Depth16>::new(size, pixels, depth).expect("it fits").starting_at(top);
                    if is_listed {
                        list.render(top, &mut band);
                    } else {
                        camera.draw(&MESH, pose, &white, &mut band);
                    }
                    assert_eq!(missing(top, depth), None, "{rows} rows, {target:?}, {camera:?}, {pose:?}");
                    top += rows;
                }
            }
        }
    }
    println!("{} cameras before a square fill their viewports", cases.len());
}
