//! The promise: no bytes panic that are given as a mesh, a texture or a mask; what is taken is what the bytes say, borrowed where they
//! lie; all else is a typed error.

use crate::common::for_all;
use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::*;
use fixel::fixed::types::{I4F12, I12F4};
use fixel::{
    Aligned, AssetError, AssetKind, Band, Camera, Depth16, Mask, MaskError, Material, Mesh, MeshError, Pose,
    Texture, TextureError, Turn, Vec3, Vertex,
};
use proptest::prelude::*;

/// Bytes at an even address, or at an odd one.
struct Placed {
    memory: Vec<u16>,
    start: usize,
    length: usize,
}

impl Placed {
    fn new(bytes: &[u8], start: usize) -> Self {
        let mut memory = vec![0_u16; (start + bytes.len()).div_ceil(2)];
        for (at, byte) in bytes.iter().enumerate() {
            let at = start + at;
            let [mut low, mut high] = memory[at / 2].to_ne_bytes();
            if at.is_multiple_of(2) {
                low = *byte
            } else {
                high = *byte
            };
            memory[at / 2] = u16::from_ne_bytes([low, high]);
        }
        Self { memory, start, length: bytes.len() }
    }

    fn bytes(&self) -> &[u8] {
        &bytemuck::must_cast_slice::<u16, u8>(&self.memory)[self.start..][..self.length]
    }
}

/// A header, byte by byte as the documentation has it.
fn header(kind: u8, detail: u8, sizes: [u32; 2]) -> Vec<u8> {
    let mut bytes = b"fxl1".to_vec();
    bytes.extend(0x0102_u16.to_ne_bytes());
    bytes.extend([kind, detail]);
    sizes.iter().for_each(|size| bytes.extend(size.to_ne_bytes()));
    bytes
}

fn mesh_bytes(vertices: &[Vertex], triangles: &[[u16; 3]], index_bytes: u8) -> Vec<u8> {
    let mut bytes = header(b'M', index_bytes, [vertices.len() as u32, triangles.len() as u32]);
    for vertex in vertices {
        vertex.position.iter().for_each(|at| bytes.extend(at.to_bits().to_ne_bytes()));
        vertex.uv.iter().for_each(|at| bytes.extend(at.to_bits().to_ne_bytes()));
        bytes.extend(vertex.color);
        vertex.normal.iter().for_each(|component| bytes.extend(component.to_ne_bytes()));
    }
    for index in triangles.as_flattened() {
        match index_bytes {
            1 => bytes.push(*index as u8),
            _ => bytes.extend(index.to_ne_bytes()),
        }
    }
    bytes
}

fn texture_bytes(kind: u8, log2: [u32; 2], data: &[u8]) -> Vec<u8> {
    [header(kind, 0, log2).as_slice(), data].concat()
}

fn vertex() -> impl Strategy<Value = Vertex> {
    any::<([i16; 3], [i16; 2], [u8; 3], [i8; 3])>().prop_map(|(position, uv, color, normal)| Vertex {
        position: position.map(I4F12::from_bits),
        uv: uv.map(I12F4::from_bits),
        color,
        normal,
    })
}

/// Vertices, and triangles that name only these.
fn parts() -> impl Strategy<Value = (Vec<Vertex>, Vec<[u16; 3]>)> {
    proptest::collection::vec(vertex(), 1..60).prop_flat_map(|vertices| {
        let index = 0..vertices.len() as u16;
        let corners = [index.clone(), index.clone(), index];
        (Just(vertices), proptest::collection::vec(corners, 0..60))
    })
}

/// Draws it, from where something of it may be seen.
fn draw(mesh: &Mesh<'_>) {
    let (mut pixels, mut depth) = ([0; 32 * 16], [0; 32 * 16]);
    let mut band = Band::<Rgb565, Depth16>::new(Size::new(32, 16), &mut pixels, &mut depth).expect("a band");
    let camera =
        Camera::perspective(Turn::from_degrees(90), band.size()).at(Vec3::lit(0.0, 0.0, 9.0)).near(0.25);
    camera.draw(mesh, &Pose::IDENTITY, &Material::gouraud(), &mut band);
}

#[test]
fn a_mesh_of_bytes_is_the_one_they_say_and_borrows_them_in_2_000_cases() {
    for_all("meshes of bytes", 2000, (parts(), 1..=2_u8), |((vertices, triangles), index_bytes)| {
        let placed = Placed::new(&mesh_bytes(&vertices, &triangles, index_bytes), 0);
        let mesh =
            Mesh::from_bytes(placed.bytes()).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(mesh.vertices(), vertices.as_slice());
        prop_assert!(mesh.triangles().eq(triangles.iter().copied()));
        prop_assert_eq!(mesh.vertices().as_ptr().cast::<u8>(), placed.bytes()[16..].as_ptr());
        let given = Mesh::try_new(&vertices, &triangles).expect("indices are in range");
        let bounds = |mesh: &Mesh<'_>| {
            let text = format!("{mesh:?}");
            text.rsplit_once("bounds").expect("the sphere around it").1.to_owned()
        };
        prop_assert_eq!(bounds(&mesh), bounds(&given));
        draw(&mesh);
        let odd = Placed::new(placed.bytes(), 1);
        prop_assert_eq!(Mesh::from_bytes(odd.bytes()).err(), Some(AssetError::Address));
        Ok(())
    });
}

#[test]
fn of_20_000_meshes_with_wrong_bytes_each_is_refused_or_whole() {
    let change = (any::<prop::sample::Index>(), any::<u8>());
    let cut = prop_oneof![3 => Just(None), 1 => any::<prop::sample::Index>().prop_map(Some)];
    let changes = (proptest::collection::vec(change, 0..4), cut, 0..8_usize);
    let strategy = (parts(), 1..=2_u8, changes);
    for_all(
        "wrong meshes",
        20_000,
        strategy,
        |((vertices, triangles), index_bytes, (changes, cut, more))| {
            let mut bytes = mesh_bytes(&vertices, &triangles, index_bytes);
            for (at, byte) in changes {
                // Half of them in the header.
                let end = if byte % 2 == 0 { 16 } else { bytes.len() };
                let at = at.index(end);
                bytes[at] = byte >> (at % 5);
            }
            if let Some(cut) = cut {
                bytes.truncate(cut.index(bytes.len()));
            }
            bytes.resize(bytes.len() + more.saturating_sub(5), 0);
            let placed = Placed::new(&bytes, 0);
            if let Ok(mesh) = Mesh::from_bytes(placed.bytes()) {
                // All of the bytes, as the header says.
                let rewritten = mesh_bytes(mesh.vertices(), &Vec::from_iter(mesh.triangles()), bytes[7]);
                prop_assert_eq!(&rewritten, &bytes);
                prop_assert!(
                    mesh.triangles().flatten().all(|index| usize::from(index) < mesh.vertices().len())
                );
                draw(&mesh);
            }
            let _ = (Texture::from_bytes(placed.bytes()), Mask::from_bytes(placed.bytes()));
            Ok(())
        },
    );
}

#[test]
fn of_20_000_strings_of_bytes_none_panics() {
    let any_bytes = proptest::collection::vec(any::<u8>(), 0..80);
    let sizes = prop_oneof![2 => [0..12_u32, 0..12_u32], 1 => any::<[u32; 2]>(), 1 => Just([u32::MAX; 2])];
    let begun = (prop::sample::select(b"MTK".to_vec()), 0..4_u8, sizes, any_bytes.clone())
        .prop_map(|(kind, detail, sizes, rest)| [header(kind, detail, sizes).as_slice(), &rest].concat());
    for_all("any bytes", 20_000, (prop_oneof![any_bytes, begun], 0..2_usize), |(bytes, start)| {
        let placed = Placed::new(&bytes, start);
        if let Ok(mesh) = Mesh::from_bytes(placed.bytes()) {
            draw(&mesh);
        }
        if let Ok(texture) = Texture::from_bytes(placed.bytes()) {
            prop_assert_eq!(16 + 2 * texture.size().width * texture.size().height, bytes.len() as u32);
        }
        let _ = Mask::from_bytes(placed.bytes());
        Ok(())
    });
}

#[test]
fn textures_and_masks_of_bytes_are_drawn_as_those_of_words() {
    let texels: Vec<u16> = (0..64 * 32).map(|i: u16| i.wrapping_mul(40503)).collect();
    let bits: Vec<u8> = (0..8 * 32).map(|i| ((i * 37) >> 1) as u8).collect();
    let placed = Placed::new(&texture_bytes(b'T', [6, 5], bytemuck::must_cast_slice::<u16, u8>(&texels)), 0);
    // Masks may lie anywhere.
    let mask_placed = Placed::new(&texture_bytes(b'K', [6, 5], &bits), 1);
    let (texture, mask) = (Texture::from_bytes(placed.bytes()), Mask::from_bytes(mask_placed.bytes()));
    let (texture, mask) = (texture.expect("a texture"), mask.expect("a mask"));
    assert_eq!(texture.size(), Size::new(64, 32));
    let picture = |texture: &Texture<'_>, mask: &Mask<'_>| {
        let (mut pixels, mut depth) = (vec![0; 64 * 32], vec![0; 64 * 32]);
        let mut band =
            Band::<Rgb565, Depth16>::new(Size::new(64, 32), &mut pixels, &mut depth).expect("a band");
        let corner = |x, y, u, v| Vertex::new(x, y, 0.0).uv(u, v);
        let vertices = [
            corner(-2.0, 1.0, 0, 0),
            corner(-2.0, -1.0, 0, 32),
            corner(2.0, -1.0, 64, 32),
            corner(2.0, 1.0, 64, 0),
        ];
        let mesh = Mesh::new(&vertices, &[[0, 1, 2], [0, 2, 3]]);
        let camera = Camera::perspective(Turn::from_degrees(60), band.size()).at(Vec3::lit(0.0, 0.0, 2.0));
        camera.draw(&mesh, &Pose::IDENTITY, &Material::textured(texture).masked(mask), &mut band);
        pixels
    };
    let by_words = picture(&Texture::new(&texels, 6, 5), &Mask::new(&bits, 6, 5));
    assert!(picture(&texture, &mask) == by_words);
    assert!(by_words.iter().filter(|pixel| **pixel != 0).count() > 400);
}

#[test]
fn each_fault_of_an_asset_has_its_error() {
    let vertices = [Vertex::new(0.0, 1.0, 2.0); 3];
    let good = mesh_bytes(&vertices, &[[0, 1, 2]], 2);
    let mesh = |bytes: &[u8]| Mesh::from_bytes(Placed::new(bytes, 0).bytes()).err();
    assert_eq!(mesh(&good), None);
    let with = |at: usize, byte: u8| {
        let mut bytes = good.clone();
        bytes[at] = byte;
        bytes
    };
    assert_eq!(mesh(&[]), Some(AssetError::NoAsset));
    assert_eq!(mesh(&good[..15]), Some(AssetError::NoAsset));
    assert_eq!(mesh(&with(3, b'2')), Some(AssetError::NoAsset));
    assert_eq!(mesh(&with(7, 3)), Some(AssetError::NoAsset));
    assert_eq!(mesh(&with(7, 0)), Some(AssetError::NoAsset));
    let mut other = good.clone();
    other.swap(4, 5);
    assert_eq!(mesh(&other), Some(AssetError::ByteOrder));
    assert_eq!(mesh(&with(4, 7)), Some(AssetError::NoAsset));
    assert_eq!(mesh(&with(6, b'T')), Some(AssetError::Kind { expected: AssetKind::Mesh }));
    assert_eq!(mesh(&good[..69]), Some(AssetError::Length { expected: 70, found: 69 }));
    assert_eq!(
        mesh(&mesh_bytes(&vertices, &[[0, 1, 3]], 2)),
        Some(AssetError::Mesh(MeshError { triangle: 0, index: 3 }))
    );
    let endless = header(b'M', 2, [u32::MAX; 2]);
    let expected = 16 + 22 * u64::from(u32::MAX);
    assert_eq!(mesh(&endless), Some(AssetError::Length { expected, found: 16 }));
    assert_eq!(
        AssetError::Length { expected: 70, found: 69 }.to_string(),
        "the asset has 70 bytes by its header, but 69 were given"
    );

    let texture = |log2, data: &[u8]| {
        Texture::from_bytes(Placed::new(&texture_bytes(b'T', log2, data), 0).bytes()).err()
    };
    assert_eq!(texture([0, 0], &[1, 2]), None);
    assert_eq!(texture([0, 0], &[1, 2, 3]), Some(AssetError::Length { expected: 18, found: 19 }));
    assert_eq!(texture([11, 0], &[1, 2]), Some(AssetError::Texture(TextureError::TooLarge)));
    assert_eq!(texture([0, u32::MAX], &[1, 2]), Some(AssetError::Texture(TextureError::TooLarge)));
    let mask = |log2, data: &[u8]| Mask::from_bytes(&texture_bytes(b'K', log2, data)).err();
    assert_eq!(mask([0, 0], &[1]), None);
    assert_eq!(mask([0, 1], &[1]), Some(AssetError::Mask(MaskError::Length { expected: 2, found: 1 })));
    assert_eq!(mask([0, 11], &[1]), Some(AssetError::Mask(MaskError::TooLarge)));
    let odd = texture_bytes(b'T', [0, 0], &[1, 2]);
    assert_eq!(Texture::from_bytes(Placed::new(&odd, 1).bytes()).err(), Some(AssetError::Address));
    assert_eq!(Texture::from_bytes(&Aligned(*odd.first_chunk::<18>().expect("18 bytes")).0).err(), None);
}
