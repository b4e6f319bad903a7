//! The promise: every kind of surface with every way to lay it over what is there, in fog or not, shows the same bytes in bands
//! of any height as in one band of the whole screen, from one core or two, and where only what changed is sent. Transparent
//! triangles come last, from back to front. A list that is full stays of use.

use crate::common;

use std::convert::Infallible;
use std::thread;

use common::for_all;
use common::scenes::{Draw, LIGHTS, MESHES, TEXELS, draw, meshes};
use fixel::embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use fixel::embedded_graphics::prelude::*;
use fixel::material::{Kind, LayerIn, LitKind};
use fixel::num::I16F16;
use fixel::{
    Band, BigEndian, BlendFormat, Canvas, CapacityError, Changes, Cull, Depth16, DepthFormat, DisplayList,
    Fog, Fragment, Gradient, Inputs, ListMemory, Mask, Material, Mesh, NoDepth, Pose, QuarterPixel, Reach,
    Shader, Surface, Texture, Varying, Vec3, Vertex,
};
use proptest::prelude::*;

/// A formula of place and target, whatever the format's order of bytes.
struct Dots;

impl<F: BlendFormat<Word = u16>> Shader<F> for Dots {
    type Quality = QuarterPixel;
    const REACH: Reach = Reach::Place;

    fn inputs(&self) -> Inputs {
        Inputs::UvColor
    }

    fn color(&self, at: &Varying) -> u16 {
        F::rgb565(at.u.to_bits() as u16)
    }

    fn fragment(&self, fragment: &Fragment<u16>) -> Option<u16> {
        let [x, y] = fragment.place;
        let near = fragment.near_w.to_bits() >> 20;
        let green = fragment.varying.color[1].to_bits() >> 16;
        ((x ^ y) & 3 != 0).then(|| F::rgb565(near as u16 ^ (green as u16) << 5))
    }
}

/// Takes red out of what is there.
struct Cyan;

impl<F: BlendFormat<Word = u16>> Shader<F> for Cyan {
    type Quality = QuarterPixel;
    const REACH: Reach = Reach::Target;

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn color(&self, _: &Varying) -> u16 {
        F::rgb565(0)
    }

    fn fragment(&self, fragment: &Fragment<u16>) -> Option<u16> {
        let [u, _] = [fragment.varying.u, fragment.varying.v].map(|at| at.to_bits() >> 16);
        (u & 4 == 0).then(|| F::multiply(fragment.target, F::rgb565(0x07ff)))
    }
}

static MASK: [u8; 32] = [
    0xff, 0x0f, 0xff, 0x0f, 0xf0, 0xff, 0xf0, 0xff, 0xc3, 0x3c, 0xc3, 0x3c, 0xff, 0xff, 0x00, 0x00, 0xaa,
    0x55, 0x55, 0xaa, 0xff, 0x0f, 0xff, 0x0f, 0xf0, 0xff, 0xf0, 0xff, 0xc3, 0x3c, 0xc3, 0x3c,
];

/// A name of a surface, for messages, and the surface.
type Named<F, D> = (String, Surface<'static, F, D>);

/// A material in all qualities.
fn in_qualities<F, D, K, L>(
    name: &str,
    material: Material<'static, K, QuarterPixel, L>,
    to: &mut Vec<Named<F, D>>,
) where
    F: BlendFormat<Word = u16>,
    D: DepthFormat,
    K: Kind,
    L: LayerIn<F>,
{
    to.push((name.to_owned(), material.surface()));
    to.push((format!("{name}, exact"), material.exact().surface()));
    to.push((format!("{name}, affine"), material.affine().surface()));
}

/// A material laid over what is there in all ways.
fn in_layers<F, D, K>(name: &str, material: Material<'static, K>, to: &mut Vec<Named<F, D>>)
where
    F: BlendFormat<Word = u16>,
    D: DepthFormat,
    K: Kind,
{
    in_qualities(name, material, to);
    in_qualities(&format!("{name}, over"), material.alpha(90), to);
    in_qualities(&format!("{name}, added"), material.additive().alpha(150), to);
    in_qualities(&format!("{name}, multiplied"), material.multiply().cull(Cull::None), to);
    in_qualities(&format!("{name}, screen door"), material.alpha(140).screen_door(), to);
    in_qualities(&format!("{name}, nearer, untested"), material.depth_bias(300).depth(false, true), to);
    in_qualities(&format!("{name}, unwritten"), material.depth(true, false), to);
}

/// As it is, and in light.
fn in_light<F, D, K>(name: &str, material: Material<'static, K>, to: &mut Vec<Named<F, D>>)
where
    F: BlendFormat<Word = u16>,
    D: DepthFormat,
    K: LitKind,
{
    in_layers(name, material, to);
    in_layers(&format!("{name} in light"), material.lit(), to);
    in_layers(&format!("{name} in light on faces"), material.lit().faceted().two_sided(), to);
}

/// All surfaces.
fn all<F: BlendFormat<Word = u16>, D: DepthFormat>() -> Vec<Named<F, D>> {
    let texture = Texture::new(&TEXELS, 4, 4);
    let mut all = Vec::new();
    let (flat, textured, clamped) =
        (Material::flat(Rgb565::CSS_GOLD), Material::textured(&texture), Material::clamped(&texture));
    in_light("flat", flat, &mut all);
    in_light("Gouraud", Material::gouraud(), &mut all);
    in_light("textured", textured, &mut all);
    in_light("textured 4 times", textured.texture_scale(2), &mut all);
    in_light("clamped", clamped, &mut all);
    in_light("mirrored", Material::mirrored(&texture), &mut all);
    let key = fixel::embedded_graphics::pixelcolor::raw::RawU16::new(TEXELS[17]).into();
    // One that turns a cut-out opaque again does not exist: its kind is of cut-outs.
    let cut_out = textured.masked(&Mask::new(&MASK, 4, 4));
    in_qualities("cut out", cut_out, &mut all);
    in_qualities("cut out in light", cut_out.lit(), &mut all);
    in_qualities("cut out, over", cut_out.alpha(77), &mut all);
    in_qualities("cut out by colour", clamped.cut_out(key).lit().faceted(), &mut all);
    in_qualities("mirrored, cut out", Material::mirrored(&texture).masked(&Mask::new(&MASK, 4, 4)), &mut all);
    in_qualities("flat, vertices over", flat.vertex_alpha(), &mut all);
    in_qualities("textured, vertices added", textured.additive().vertex_alpha(), &mut all);
    in_qualities("clamped, vertices' door", clamped.screen_door().vertex_alpha(), &mut all);
    all.push(("a shader that sees place".into(), Surface::new(&Dots)));
    all.push(("a shader that sees the target".into(), Surface::new(&Cyan)));
    all
}

/// A draw with one of all surfaces, and perhaps in fog.
#[derive(Clone, Copy, Debug)]
struct Layered {
    draw: Draw,
    surface: usize,
    fog: u8,
}

fn layered(most: usize) -> impl Strategy<Value = Vec<Layered>> {
    let one = (draw(), any::<u16>(), 0..4_u8);
    prop::collection::vec(
        one.prop_map(|(draw, surface, fog)| Layered { draw, surface: surface.into(), fog }),
        1..=most,
    )
}

/// What stands still.
struct World<F: BlendFormat<Word = u16>, D: DepthFormat> {
    surfaces: Vec<Named<F, D>>,
    sky: Gradient,
}

impl<F: BlendFormat<Word = u16>, D: DepthFormat> World<F, D> {
    fn new() -> Self {
        let sky = Gradient::new(Rgb888::CSS_MIDNIGHT_BLUE, Rgb888::CSS_LIGHT_PINK, 50);
        Self { surfaces: all(), sky }
    }

    fn draw<'a, C>(&'a self, layered: &Layered, screen: Size, canvas: &mut C) -> C::Output
    where
        C: Canvas<'a, Format = F, Depth = D>,
    {
        let (camera, mesh) = (layered.draw.camera(screen), &meshes()[layered.draw.mesh]);
        let surface = self.surfaces[layered.surface % self.surfaces.len()].1;
        let view = camera.lit_by(&LIGHTS);
        let color = Rgb565::CSS_LIGHT_GRAY;
        let fog = match layered.fog {
            0 | 1 => return view.draw(mesh, &layered.draw.pose, surface, canvas),
            2 => Fog::linear(color, I16F16::lit("1"), I16F16::lit("6")),
            _ => Fog::exponential(color, I16F16::lit("0.2")).towards(&self.sky),
        };
        view.in_fog(&fog).draw(mesh, &layered.draw.pose, surface, canvas)
    }
}

type Memory = ListMemory<3000, 1500>;
type List<'a, F, D> = DisplayList<'a, F, D, 16>;

/// Pixels and depths of the whole screen, in bands of some height.
fn rendered<F, D>(
    list: &mut List<'_, F, D>,
    screen: Size,
    rows: u32,
    sky: &Gradient,
) -> (Vec<u16>, Vec<D::Word>)
where
    F: BlendFormat<Word = u16>,
    D: DepthFormat,
{
    let words = (screen.width * rows) as usize;
    let (mut pixels, mut depth) = (vec![0; words], vec![D::CLEAR; words]);
    let size = Size::new(screen.width, rows);
    let mut band = Band::<F, D>::new(size, &mut pixels, &mut depth).expect("the band is small");
    let (mut all, mut all_depth) = (Vec::new(), Vec::new());
    let Ok(()) = list.render_bands(screen.height, sky, &mut band, |_, band| {
        all.extend_from_slice(band.pixels());
        all_depth.extend_from_slice(band.depth());
        Ok::<_, Infallible>(())
    });
    (all, all_depth)
}

fn bands_show_the_whole_picture<F, D>(name: &str, usual: u32)
where
    F: BlendFormat<Word = u16>,
    D: DepthFormat<Word: PartialEq + std::fmt::Debug>,
{
    let world = World::<F, D>::new();
    let screen = (1..70_u32, 1..60_u32).prop_map(|(width, height)| Size::new(width, height));
    let count = std::cell::Cell::new(0);
    for_all(name, usual, (screen, layered(6), 1..70_u32), |(screen, draws, any)| {
        let mut memory = Box::new(Memory::new());
        let mut list = List::new(&mut *memory);
        for layered in &draws {
            world.draw(layered, screen, &mut list).expect("the list is large");
        }
        count.set(count.get() + list.lengths()[1]);
        let whole = rendered(&mut list, screen, screen.height, &world.sky);
        for rows in [1, 3, 16, any] {
            let parts = rendered(&mut list, screen, rows, &world.sky);
            let names: Vec<_> = draws
                .iter()
                .map(|layered| &world.surfaces[layered.surface % world.surfaces.len()].0)
                .collect();
            prop_assert!(parts == whole, "{} rows: {:?}", rows, names);
        }
        Ok(())
    });
    println!("{name}: {} surfaces, {} triangles", world.surfaces.len(), count.get());
    assert!(count.get() > 10 * usual as usize);
}

#[test]
fn every_pair_of_surfaces_shows_the_same_in_bands_of_any_height() {
    bands_show_the_whole_picture::<Rgb565, Depth16>("surfaces in bands", 700);
    bands_show_the_whole_picture::<BigEndian<Rgb565>, NoDepth>("surfaces in bands without depth", 400);
}

/// Whether a surface shows what is behind it.
fn is_transparent(name: &str) -> bool {
    ["over", "added", "multiplied", "target"].iter().any(|word| name.contains(word))
}

#[test]
fn a_list_is_drawn_like_draws_at_once_in_its_order() {
    let world = World::<Rgb565, Depth16>::new();
    let screen = Size::new(64, 48);
    let differ = std::cell::Cell::new(0);
    for_all("opaque, then one transparent", 600, (layered(5), any::<u16>()), |(draws, last)| {
        let name = |layered: &Layered| world.surfaces[layered.surface % world.surfaces.len()].0.as_str();
        let opaque: Vec<_> = draws.iter().filter(|layered| !is_transparent(name(layered))).copied().collect();
        // A transparent ground, of two triangles that do not overlap: its order is of no consequence.
        let transparent = Layered {
            draw: Draw { mesh: MESHES - 1, ..draws[0].draw },
            surface: (0..world.surfaces.len())
                .cycle()
                .skip(last.into())
                .find(|&i| is_transparent(&world.surfaces[i].0))
                .expect("there is one"),
            fog: draws[0].fog,
        };
        let (mut pixels, mut depth) = (vec![0; 64 * 48], vec![0; 64 * 48]);
        let mut band = Band::<Rgb565, Depth16>::new(screen, &mut pixels, &mut depth).expect("a band");
        band.clear_to(&world.sky);
        for layered in opaque.iter().chain([&transparent]) {
            world.draw(layered, screen, &mut band);
        }
        // In the list it comes first, or somewhere between.
        let mut memory = Box::new(Memory::new());
        let mut list = List::new(&mut *memory);
        let place = usize::from(last) % (opaque.len() + 1);
        let (before, after) = opaque.split_at(place);
        for layered in before.iter().chain([&transparent]).chain(after) {
            world.draw(layered, screen, &mut list).expect("the list is large");
        }
        let listed = rendered(&mut list, screen, 16, &world.sky);
        prop_assert!(listed == (pixels, depth), "{:?} at {}", name(&transparent), place);
        differ.set(differ.get() + 1);
        Ok(())
    });
    assert!(differ.get() > 0);
}

#[test]
fn panes_are_drawn_from_back_to_front_whatever_their_order() {
    let screen = Size::new(32, 24);
    let camera = fixel::Camera::focal(16.0, screen).near(0.5);
    let colors = [Rgb565::RED, Rgb565::GREEN, Rgb565::BLUE, Rgb565::YELLOW, Rgb565::WHITE];
    let pane = |i: usize| {
        (Pose::IDENTITY.at(Vec3::new(I16F16::ZERO, I16F16::ZERO, I16F16::from_num(-1 - i as i32))), colors[i])
    };
    let corner = |x, y| Vertex::new(x, y, 0.0);
    let corners = [corner(-7.0, 7.0), corner(-7.0, -7.0), corner(7.0, -7.0), corner(7.0, 7.0)];
    let shape = Mesh::try_new(&corners, &[[0, 1, 2], [0, 2, 3]]).expect("a square");
    // Exactly, by the formula, from the farthest on.
    let (mut exact, half) = (0x1234, 100);
    for &color in colors.iter().rev() {
        exact = Rgb565::over(exact, color.into_storage(), half);
    }
    for_all("orders of panes", 60, Just(vec![0, 1, 2, 3, 4]).prop_shuffle(), |order| {
        let mut memory = Memory::new();
        let mut list = DisplayList::<Rgb565, NoDepth, 5>::new(&mut memory);
        for &i in &order {
            let (pose, color) = pane(i);
            let material = Material::flat(color).alpha(half).cull(Cull::None);
            camera.draw(&shape, &pose, &material, &mut list).expect("there is room");
        }
        let mut pixels = vec![0x1234; 32 * 24];
        let mut band = Band::<Rgb565, NoDepth>::new(screen, &mut pixels, &mut []).expect("a band");
        list.render(0, &mut band);
        prop_assert_eq!(pixels[12 * 32 + 16], exact);
        Ok(())
    });
}

#[test]
fn two_threads_draw_all_surfaces_of_one_list() {
    let world = World::<Rgb565, Depth16>::new();
    let screen = Size::new(60, 48);
    for_all("surfaces on two threads", 60, layered(6), |draws| {
        let mut memory = Box::new(Memory::new());
        let mut list = List::new(&mut *memory);
        for layered in &draws {
            world.draw(layered, screen, &mut list).expect("the list is large");
        }
        let whole = rendered(&mut list, screen, 48, &world.sky).0;
        let band = |number: u32| {
            let (mut pixels, mut depth) = (vec![0; 60 * 16], vec![0; 60 * 16]);
            let mut band = Band::<Rgb565, Depth16>::new(Size::new(60, 16), &mut pixels, &mut depth)
                .expect("a band")
                .starting_at(16 * number);
            band.clear_to(&world.sky);
            list.render(16 * number, &mut band);
            pixels
        };
        let (mut first, second, third) = thread::scope(|scope| {
            let (first, second) = (scope.spawn(|| band(0)), scope.spawn(|| band(1)));
            (first.join().expect("drawn"), second.join().expect("drawn"), band(2))
        });
        first.extend(second);
        first.extend(third);
        prop_assert!(first == whole);
        Ok(())
    });
}

#[test]
fn sending_only_what_changed_shows_all_surfaces() {
    let world = World::<Rgb565, Depth16>::new();
    let screen = Size::new(60, 48);
    for_all("surfaces that change", 60, prop::collection::vec(layered(3), 2..5), |frames| {
        let (mut shown, mut changes) = (vec![0; 60 * 48], Changes::<3>::new());
        let (mut pixels, mut depth) = (vec![0; 60 * 16], vec![0; 60 * 16]);
        let mut band =
            Band::<Rgb565, Depth16>::new(Size::new(60, 16), &mut pixels, &mut depth).expect("a band");
        for draws in &frames {
            let mut memory = Box::new(Memory::new());
            let mut list = List::new(&mut *memory);
            for layered in draws {
                world.draw(layered, screen, &mut list).expect("the list is large");
            }
            let Ok(_) = list.render_changed(48, &world.sky, &mut band, &mut changes, |area, band| {
                for (y, row) in (area.top_left.y..).zip(band.rows_in(&area)) {
                    let start = (y * 60 + area.top_left.x) as usize;
                    shown[start..start + row.len()].copy_from_slice(row);
                }
                Ok::<_, Infallible>(())
            });
            prop_assert!(shown == rendered(&mut list, screen, 48, &world.sky).0);
        }
        Ok(())
    });
}

#[test]
fn shortcuts_give_the_bytes_of_the_general_way_and_in_fog_to_a_step() {
    let screen = Size::new(64, 48);
    let fog = Fog::exponential(Rgb565::WHITE, I16F16::lit("0.2"));
    let gold = Material::flat(Rgb565::CSS_GOLD);
    // On the left the shortcut: drawn in place, or blended run by run. On the right the same in blocks, because vertices might say
    // how opaque they are (all are), or because depth is to be written as it is.
    type Pair = [Surface<'static, Rgb565, Depth16>; 2];
    let pairs: [Pair; 4] = [
        [gold.alpha(96).surface(), gold.vertex_alpha().alpha(96).surface()],
        [gold.additive().alpha(200).surface(), gold.additive().vertex_alpha().alpha(200).surface()],
        [gold.multiply().surface(), gold.multiply().vertex_alpha().surface()],
        [gold.surface(), gold.depth(true, true).surface()],
    ];
    let ball = fixel::shapes::icosphere::<42, 80>(0.8, 2);
    let opaque: Vec<_> = ball.mesh().vertices().iter().map(|vertex| vertex.alpha(255)).collect();
    let triangles: Vec<_> = ball.mesh().triangles().collect();
    let mesh = Mesh::try_new(&opaque, &triangles).expect("a ball");
    let stone = Material::gouraud().surface();
    for_all(
        "shortcuts",
        400,
        (draw(), draw(), 0..4_usize, any::<bool>()),
        |(behind, before, pair, foggy)| {
            let pictures = pairs[pair].map(|surface| {
                let pixels: Vec<u16> = (0..64 * 48_u16).map(|i| i.wrapping_mul(40_503)).collect();
                let (mut pixels, mut depth) = (pixels, vec![0; 64 * 48]);
                let mut band = Band::<Rgb565, Depth16>::new(screen, &mut pixels, &mut depth).expect("a band");
                let camera = behind.camera(screen);
                camera.draw(&meshes()[behind.mesh], &behind.pose, stone, &mut band);
                if foggy {
                    camera.in_fog(&fog).draw(&mesh, &before.pose, surface, &mut band);
                } else {
                    camera.draw(&mesh, &before.pose, surface, &mut band);
                }
                (pixels, depth)
            });
            let [left, right] = &pictures;
            prop_assert!(left.1 == right.1, "depths of pair {}", pair);
            if foggy {
                // Fog is interpolated from where a run begins, and a block is another run: each is within its step.
                let channels = |word: u16| [word >> 11, word >> 5 & 63, word & 31];
                let off =
                    |(&a, &b): (&u16, &u16)| (0..3).map(move |i| channels(a)[i].abs_diff(channels(b)[i]));
                prop_assert!(left.0.iter().zip(&right.0).flat_map(off).all(|off| off <= 1), "pair {}", pair);
            } else {
                prop_assert!(left.0 == right.0, "pair {}", pair);
            }
            Ok(())
        },
    );
}

#[test]
fn one_list_holds_all_that_a_game_has() {
    static MEMORY: static_cell::ConstStaticCell<ListMemory<900, 500>> =
        static_cell::ConstStaticCell::new(ListMemory::new());
    let memory = MEMORY.take();
    let screen = Size::new(64, 48);
    let texture = Texture::new(&TEXELS, 4, 4);
    let (sky, mask) = (Gradient::new(Rgb888::CSS_NAVY, Rgb888::CSS_PEACH_PUFF, 48), Mask::new(&MASK, 4, 4));
    let camera = fixel::Camera::focal(40.0, screen).near(0.25).at(Vec3::lit(0.0, 0.0, 3.0));
    let [ball, ground] = [meshes()[2], meshes()[3]];
    let at =
        |x: f32, z: f32| Pose::IDENTITY.at(Vec3::new(I16F16::from_num(x), I16F16::ZERO, I16F16::from_num(z)));
    let mut pictures = Vec::new();
    for frame in 0..3_u8 {
        // Made in the frame: lights, fog, materials.
        let torch = [fixel::Light::point(Vec3::lit(0.0, 1.0, 2.0), [255, 90 * frame, 60], I16F16::lit("9"))];
        let lights = fixel::Lights::new([30; 3], &torch);
        let fog = Fog::linear(Rgb565::WHITE, I16F16::lit("2"), I16F16::lit("9")).towards(&sky);
        let view = camera.lit_by(&lights).in_fog(&fog);
        let red = Material::flat(Rgb565::RED);
        let bricks = Material::textured(&texture);
        let glass = Material::flat(Rgb565::CSS_SKY_BLUE).alpha(96);
        let tree = bricks.masked(&mask).lit().two_sided();
        fn scene<'a, C: Canvas<'a, Format = Rgb565, Depth = Depth16>>(
            canvas: &mut C,
            draws: &[(&fixel::Mesh<'a>, Pose, Surface<'a, Rgb565, Depth16>)],
            view: &fixel::View<'_, Fog<'a>>,
        ) where
            C::Output: std::fmt::Debug,
        {
            for (mesh, pose, surface) in draws {
                let _ = view.draw(mesh, pose, surface, canvas);
            }
        }
        let opaque = [
            (&ground, at(0.0, 0.0), bricks.lit().exact().surface()),
            (&ball, at(-1.0, -1.0), red.surface()),
            (&ball, at(1.0, -1.0), bricks.lit().surface()),
            (&ball, at(0.0, -2.0), tree.surface()),
            (&ball, at(0.5, 0.5), Surface::new(&Dots)),
        ];
        let panes = [(&ball, at(0.0, 0.0), glass.surface()), (&ball, at(0.0, 1.0), glass.surface())];
        let mut list = DisplayList::<Rgb565, Depth16, 8>::new(memory);
        scene(&mut list, &panes[1..], &view);
        scene(&mut list, &opaque, &view);
        scene(&mut list, &panes[..1], &view);
        assert_eq!(list.lengths()[2], 7);
        let (mut pixels, mut depth) = (vec![0; 64 * 16], vec![0; 64 * 16]);
        let mut band =
            Band::<Rgb565, Depth16>::new(Size::new(64, 16), &mut pixels, &mut depth).expect("a band");
        let mut listed = Vec::new();
        let Ok(()) = list.render_bands(48, &sky, &mut band, |_, band| {
            listed.extend_from_slice(band.pixels());
            Ok::<_, Infallible>(())
        });
        // At once, in the list's order: a convex pane's triangles that face the eye do not overlap.
        let (mut pixels, mut depth) = (vec![0; 64 * 48], vec![0; 64 * 48]);
        let mut band = Band::<Rgb565, Depth16>::new(screen, &mut pixels, &mut depth).expect("a band");
        band.clear_to(&sky);
        scene(&mut band, &opaque, &view);
        scene(&mut band, &panes, &view);
        assert!(listed == pixels, "frame {frame}");
        pictures.push(listed);
    }
    pictures.dedup();
    assert_eq!(pictures.len(), 3, "the torch changes");
}

#[test]
fn a_clamped_texture_is_a_repeated_one_where_coordinates_stay_inside() {
    let texels: Vec<u16> = (0..64 * 64_u16).map(|i| i.wrapping_mul(40_503)).collect();
    let texture = Texture::new(&texels, 6, 6);
    // Up to its very borders.
    let corner =
        || ([-40..110_i32, -30..80_i32], 1..=255_u32, [0..=64 * 16_i32, 0..=64 * 16_i32], any::<[u8; 3]>());
    let same = std::cell::Cell::new(0);
    for_all("clamped inside", 2_000, ([corner(), corner(), corner()], any::<bool>()), |(corners, is_lit)| {
        let vertices = corners.map(|([x, y], q, uv, color)| fixel::ScreenVertex {
            x: fixel::num::I12F4::from_num(x),
            y: fixel::num::I12F4::from_num(y),
            q: fixel::num::U1F31::from_bits(q << 23),
            u: I16F16::from_bits(uv[0] << 12),
            v: I16F16::from_bits(uv[1] << 12),
            color: color.map(fixel::num::U8F8::from),
        });
        // Small ones that repeat are drawn at one go, and may bend otherwise.
        let side = |axis: usize| {
            let at = corners.iter().map(|(place, ..)| place[axis]);
            at.clone().max().unwrap_or_default() - at.min().unwrap_or_default()
        };
        if side(0).max(side(1)) < 64 {
            return Ok(());
        }
        let (repeated, clamped) = (Material::textured(&texture), Material::clamped(&texture));
        let surfaces: [Surface<Rgb565, Depth16>; 2] = if is_lit {
            [repeated.lit().surface(), clamped.lit().surface()]
        } else {
            [repeated.surface(), clamped.surface()]
        };
        let [left, right] = surfaces.map(|surface| {
            let (mut pixels, mut depth) = (vec![0; 64 * 48], vec![0; 64 * 48]);
            let mut band =
                Band::<Rgb565, Depth16>::new(Size::new(64, 48), &mut pixels, &mut depth).expect("a band");
            fixel::draw_triangle(&vertices, Cull::None, surface, &mut band).expect("the corners are near");
            pixels
        });
        same.set(same.get() + left.iter().filter(|&&word| word != 0).count());
        prop_assert!(left == right);
        Ok(())
    });
    println!("{} pixels", same.get());
    assert!(same.get() > 100_000);
}

#[test]
fn whatever_is_called_in_between_a_list_keeps_its_order() {
    let world = World::<Rgb565, Depth16>::new();
    let screen = Size::new(60, 48);
    // Sorted, rendered or cleared between draws.
    let events = prop::collection::vec((layered(2), 0..6_u8), 1..8);
    for_all("sequences of draws", 200, events, |events| {
        let (mut memory, mut other) = (Box::new(Memory::new()), Box::new(Memory::new()));
        let mut list = List::new(&mut *memory);
        let mut since = Vec::new();
        for (draws, event) in &events {
            match event {
                0 => list.sort_back_to_front(),
                1 => {
                    list.clear();
                    since.clear();
                }
                2 => {
                    list.sort_back_to_front();
                    rendered(&mut list, screen, 48, &world.sky);
                }
                _ => {}
            }
            for layered in draws {
                world.draw(layered, screen, &mut list).expect("the list is large");
                since.push(*layered);
            }
        }
        // The same without what was in between.
        let mut plain = List::new(&mut *other);
        for layered in &since {
            world.draw(layered, screen, &mut plain).expect("the list is large");
        }
        prop_assert!(
            rendered(&mut list, screen, 16, &world.sky) == rendered(&mut plain, screen, 48, &world.sky)
        );
        Ok(())
    });
}

#[test]
fn the_largest_list_takes_opaque_triangles_after_transparent_ones() {
    let corner = |x, y| Vertex::new(x, y, 0.0);
    let corners = [corner(-0.5, 0.5), corner(-0.5, -0.5), corner(0.5, -0.5)];
    let many = vec![[0, 1, 2]; 32_768];
    let (large, small) = (Mesh::try_new(&corners, &many), Mesh::try_new(&corners, &many[..1]));
    let [large, small] = [large, small].map(|mesh| mesh.expect("triangles"));
    let screen = Size::new(8, 8);
    let camera = fixel::Camera::focal(8.0, screen).near(0.5).at(Vec3::lit(0.0, 0.0, 2.0));
    let mut memory = Box::new(ListMemory::<16, 40_000>::new());
    let mut list = DisplayList::<Rgb565, Depth16, 8>::new(&mut *memory);
    let red = Material::flat(Rgb565::RED);
    camera.draw(&large, &Pose::IDENTITY, &red, &mut list).expect("there is room");
    camera.draw(&small, &Pose::IDENTITY, &red.alpha(128), &mut list).expect("there is room");
    for _ in 0..2 {
        let nearer = Pose::IDENTITY.at(Vec3::lit(0.0, 0.0, 0.5));
        camera.draw(&small, &nearer, &Material::flat(Rgb565::BLUE), &mut list).expect("there is room");
    }
    let (mut pixels, mut depth) = (vec![0; 64], vec![0; 64]);
    let mut band = Band::<Rgb565, Depth16>::new(screen, &mut pixels, &mut depth).expect("a band");
    list.render(0, &mut band);
    assert_eq!(list.lengths()[1], 32_771);
    assert!(pixels.contains(&Rgb565::BLUE.into_storage()));
}

/// Draws what fits, and goes on without what does not.
fn driven<const V: usize, const T: usize, const N: usize>(
    world: &World<Rgb565, Depth16>,
    draws: &[Layered],
) -> [u32; 3] {
    let screen = Size::new(64, 48);
    let mut full = [0; 3];
    let mut memory = Box::new(ListMemory::<V, T>::new());
    let mut large = Box::new(Memory::new());
    let mut list = DisplayList::<Rgb565, Depth16, N>::new(&mut *memory);
    let mut other = List::new(&mut *large);
    for layered in draws {
        let before = list.lengths();
        match world.draw(layered, screen, &mut list) {
            Ok(()) => {
                let [vertices, triangles] = meshes()[layered.draw.mesh].most_in_list();
                let [now, now_triangles, _] = list.lengths();
                assert!(now - before[0] <= vertices && now_triangles - before[1] <= triangles);
                world.draw(layered, screen, &mut other).expect("this one is large");
            }
            Err(error) => {
                assert_eq!(list.lengths(), before, "{error}");
                let (number, capacity, needed) = match error {
                    CapacityError::Vertices { capacity, needed } => (0, capacity, needed),
                    CapacityError::Triangles { capacity, needed } => (1, capacity, needed),
                    CapacityError::Draws { capacity, needed } => (2, capacity, needed),
                };
                assert_eq!(capacity, [V, T, N][number]);
                assert!(needed > capacity, "{error}");
                full[number] += 1;
            }
        }
    }
    let picture = |list: &mut DisplayList<'_, Rgb565, Depth16, N>| {
        let (mut pixels, mut depth) = (vec![0; 64 * 16], vec![0; 64 * 16]);
        let mut band =
            Band::<Rgb565, Depth16>::new(Size::new(64, 16), &mut pixels, &mut depth).expect("a band");
        let mut all = Vec::new();
        let Ok(()) = list.render_bands(48, &world.sky, &mut band, |_, band| {
            all.extend_from_slice(band.pixels());
            Ok::<_, Infallible>(())
        });
        all
    };
    assert_eq!(picture(&mut list), rendered(&mut other, screen, 48, &world.sky).0);
    full
}

#[test]
fn a_list_that_is_driven_to_its_capacity_in_every_way_goes_on_without_what_does_not_fit() {
    let world = World::<Rgb565, Depth16>::new();
    let full = std::cell::Cell::new([0; 3]);
    for_all("full lists", 300, (layered(12), 0..4_u8), |(draws, size)| {
        let errors = match size {
            0 => driven::<90, 300, 16>(&world, &draws),
            1 => driven::<1500, 60, 16>(&world, &draws),
            2 => driven::<1500, 900, 3>(&world, &draws),
            _ => driven::<150, 90, 5>(&world, &draws),
        };
        let all = full.get();
        full.set([0, 1, 2].map(|i| all[i] + errors[i]));
        Ok(())
    });
    println!("vertices, triangles and draws did not fit {:?} times", full.get());
    assert!(full.get().iter().all(|&times| times > 20));
}
