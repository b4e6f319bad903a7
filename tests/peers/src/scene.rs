//! The scenes, by name: what they are made of is in `examples/firmware`.

use fixel::{Mesh, Pose, Turn};
use fixel_firmware::bench;

/// What is drawn on the triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The repeated texture.
    Textured,
    /// White, lit at the vertices.
    Lit,
    /// The texture times the light at the vertices.
    TexturedLit,
    /// One colour.
    Flat,
}

impl Surface {
    /// Whether it shows the texture.
    #[must_use]
    pub const fn is_textured(self) -> bool {
        matches!(self, Self::Textured | Self::TexturedLit)
    }
}

/// One picture that every library is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scene {
    /// Its name in the table.
    pub name: &'static str,
    /// What it shows, in a few words.
    pub what: &'static str,
    /// What is on the triangles.
    pub surface: Surface,
    /// Whether a depth buffer hides what is behind. Otherwise triangles come back to front.
    pub depth: bool,
    /// Whether it reaches behind the eye.
    pub crosses_near_plane: bool,
    pub(crate) thing: Thing,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Thing {
    /// Rolled by so many degrees.
    Floor(i32),
    Ground,
    Cube,
    Torus,
    TexturedTorus,
}

impl Thing {
    /// The mesh, and the pose that brings it before the camera.
    pub(crate) const fn placed(self) -> (Mesh<'static>, Pose) {
        match self {
            Self::Floor(roll) => (bench::FLOOR, bench::floor_pose(Turn::from_degrees(roll))),
            Self::Ground => {
                (bench::GROUND, bench::GROUND_POSE.then(bench::GROUND_CAMERA.placement().inverse()))
            }
            Self::Cube => (bench::CUBE, bench::S2),
            Self::Torus => (bench::TORUS_MESH, bench::S3),
            Self::TexturedTorus => (bench::TEXTURED_TORUS_MESH, bench::S3),
        }
    }
}

/// All scenes, in the order of the table.
pub const SCENES: [Scene; 9] = [
    Scene { what: "floor", ..textured("s1", Thing::Floor(0)) },
    Scene { what: "floor, rolled 30°", ..textured("s1_roll30", Thing::Floor(30)) },
    Scene { what: "floor, rolled 90°", ..textured("s1_roll90", Thing::Floor(90)) },
    Scene { what: "ground, clipped", crosses_near_plane: true, ..textured("s1_ground", Thing::Ground) },
    Scene { what: "cube, depth", depth: true, ..textured("s2", Thing::Cube) },
    Scene { what: "lit torus, depth", depth: true, surface: Surface::Lit, ..textured("s3", Thing::Torus) },
    Scene {
        what: "lit textured torus, depth",
        depth: true,
        surface: Surface::TexturedLit,
        ..textured("s3_tex", Thing::TexturedTorus)
    },
    Scene { what: "cube in one colour", surface: Surface::Flat, ..textured("s2_flat", Thing::Cube) },
    Scene { what: "torus in one colour", surface: Surface::Flat, ..textured("s3_flat", Thing::Torus) },
];

const fn textured(name: &'static str, thing: Thing) -> Scene {
    Scene { name, what: "", surface: Surface::Textured, depth: false, crosses_near_plane: false, thing }
}
