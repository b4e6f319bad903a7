//! What a camera sees of a triangle, in `f64`, from the definitions alone.
//!
//! A point of the screen stands for a ray from the eye. Where the ray meets a triangle's plane follows from three
//! determinants, whether the triangle's corners are before the eye or not: no division by w, no clipping, nothing is
//! rounded. Clipping comes in only to tell where the triangle's picture ends.

/// Where something stands: scaled along each of its axes, turned, moved, in this order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    /// Rows.
    pub(crate) rotation: [[f64; 3]; 3],
    pub(crate) scale: [f64; 3],
    pub(crate) translation: [f64; 3],
}

impl Placement {
    /// Where a vector of the mesh points, its length included.
    fn vector(&self, vector: [f64; 3]) -> [f64; 3] {
        let scaled = [0, 1, 2].map(|i| vector[i] * self.scale[i]);
        self.rotation.map(|row| dot(row, scaled))
    }

    /// Where a point of the mesh is.
    pub(crate) fn point(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = self.vector(point);
        [0, 1, 2].map(|i| turned[i] + self.translation[i])
    }

    /// A vector at right angles to a triangle of the mesh where it stands, on the side that is outside: from which its corners
    /// run counter-clockwise, or, where they stand in a mirror image, clockwise.
    pub(crate) fn outwards(&self, corners: [[f64; 3]; 3]) -> [f64; 3] {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| self.vector(axis));
        let hand = dot(axes[0], cross(axes[1], axes[2])).signum();
        let [a, b, c] = corners.map(|corner| self.vector(corner));
        let edge = |to: [f64; 3]| [0, 1, 2].map(|i| to[i] - a[i]);
        cross(edge(b), edge(c)).map(|component| component * hand)
    }
}

/// How the camera draws.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lens {
    /// In pixels; of a world unit for an orthographic one.
    pub(crate) focal: f64,
    /// Where the line of sight meets the screen, in pixels.
    pub(crate) center: [f64; 2],
    pub(crate) near: f64,
    pub(crate) far: f64,
    pub(crate) orthographic: bool,
}

/// The last pixel columns and rows that a picture may reach before it is clipped: −1023 … 1022.
const GUARD_BAND: [f64; 2] = [-1023.0, 1022.0];

#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    lens: Lens,
    /// Mesh to eye: right, up, and before the eye (w).
    matrix: [[f64; 3]; 3],
    offset: [f64; 3],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A point on its way to the screen: divided by the third, the first two are pixels. The last is its distance w.
type Homogeneous = [f64; 4];

impl View {
    /// The camera's axes are the columns of its rotation: right, up, and backwards.
    pub(crate) fn new(lens: Lens, camera: Placement, pose: Placement) -> Self {
        let axes = [0, 1, 2].map(|axis| {
            let sign = if axis == 2 { -1.0 } else { 1.0 };
            camera.rotation.map(|row| sign * row[axis])
        });
        let column = |i: usize| pose.rotation.map(|row| row[i] * pose.scale[i]);
        let moved = [0, 1, 2].map(|i| pose.translation[i] - camera.translation[i]);
        Self {
            lens,
            matrix: axes.map(|axis| [0, 1, 2].map(|i| dot(axis, column(i)))),
            offset: axes.map(|axis| dot(axis, moved)),
        }
    }

    /// Right, up, and distance w before the eye.
    pub(crate) fn eye(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| dot(self.matrix[i], point) + self.offset[i])
    }

    /// Above 0, or below where what is seen is a mirror image: the determinant of what takes the mesh before the eye.
    pub(crate) fn handedness(&self) -> f64 {
        let [right, up, [x, y, z]] = self.matrix;
        // Right, up and backwards are right-handed.
        dot(right, cross(up, [-x, -y, -z]))
    }

    fn homogeneous(&self, point: [f64; 3]) -> Homogeneous {
        let Lens { focal, center, orthographic, .. } = self.lens;
        let [right, up, w] = self.eye(point);
        let divisor = if orthographic { 1.0 } else { w };
        [focal * right + center[0] * divisor, -focal * up + center[1] * divisor, divisor, w]
    }

    /// Where a point is on the screen, in pixels, and its w; only if w is above 0 or the view orthographic.
    pub(crate) fn screen(&self, point: [f64; 3]) -> Option<([f64; 2], f64)> {
        let [x, y, divisor, w] = self.homogeneous(point);
        (divisor > 0.0).then(|| ([x / divisor, y / divisor], w))
    }

    /// near/w, or 1 at the near and 0 at the far plane.
    pub(crate) fn q(&self, w: f64) -> f64 {
        let Lens { near, far, orthographic, .. } = self.lens;
        if orthographic { (far - w) / (far - near) } else { near / w }
    }

    pub(crate) fn facet(&self, corners: [[f64; 3]; 3]) -> Facet {
        let corners = corners.map(|corner| self.homogeneous(corner));
        let [a, b, c] = corners.map(|[x, y, divisor, _]| [x, y, divisor]);
        // Seen from the eye; y goes down.
        let turn = dot(a, cross(b, c));
        Facet { corners, turn, outline: self.outline(&corners) }
    }

    /// What the planes and the guard band leave of a triangle.
    fn outline(&self, corners: &[Homogeneous; 3]) -> Vec<Stretch> {
        let Lens { near, far, .. } = self.lens;
        let [low, high] = GUARD_BAND;
        let distances: [&dyn Fn(Homogeneous) -> f64; 6] = [
            &|[_, _, _, w]| w - near,
            &|[_, _, _, w]| if far == f64::INFINITY { 1.0 } else { far - w },
            &|[x, _, divisor, _]| x - low * divisor,
            &|[x, _, divisor, _]| high * divisor - x,
            &|[_, y, divisor, _]| y - low * divisor,
            &|[_, y, divisor, _]| high * divisor - y,
        ];
        let mut polygon: Vec<_> = corners.iter().copied().zip([0, 1, 2].map(Some)).collect();
        for distance in distances {
            polygon = cut(&polygon, distance);
        }
        let place = |[x, y, divisor, _]: Homogeneous| [x / divisor, y / divisor];
        let next = polygon.iter().cycle().skip(1);
        polygon
            .iter()
            .zip(next)
            .map(|((from, edge), (to, _))| Stretch {
                from: place(*from),
                to: place(*to),
                w: from[3],
                edge: *edge,
            })
            .collect()
    }
}

/// The part of a polygon where `distance` is not negative. Beside each corner stands the edge that begins there.
fn cut(
    polygon: &[(Homogeneous, Option<usize>)],
    distance: &dyn Fn(Homogeneous) -> f64,
) -> Vec<(Homogeneous, Option<usize>)> {
    let mut left = Vec::new();
    for (i, (here, edge)) in polygon.iter().enumerate() {
        let (there, _) = polygon[(i + 1) % polygon.len()];
        let (near, far) = (distance(*here), distance(there));
        let crossing = || [0, 1, 2, 3].map(|k| (here[k] * far - there[k] * near) / (far - near));
        if near >= 0.0 {
            left.push((*here, *edge));
        }
        if near >= 0.0 && far < 0.0 {
            left.push((crossing(), None));
        } else if near < 0.0 && far >= 0.0 {
            left.push((crossing(), *edge));
        }
    }
    left
}

/// A side of what is seen of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    pub(crate) from: [f64; 2],
    pub(crate) to: [f64; 2],
    /// w at its beginning.
    pub(crate) w: f64,
    /// The edge of the triangle that it is a part of: 0 from corner 0 to 1 and so on; none if a plane cut here.
    pub(crate) edge: Option<usize>,
}

impl Stretch {
    /// From a point of the screen, in pixels.
    pub(crate) fn distance(&self, [x, y]: [f64; 2]) -> f64 {
        let ([ax, ay], [bx, by]) = (self.from, self.to);
        let (dx, dy) = (bx - ax, by - ay);
        let length = dx * dx + dy * dy;
        let t = if length > 0.0 { (((x - ax) * dx + (y - ay) * dy) / length).clamp(0.0, 1.0) } else { 0.0 };
        (ax + t * dx - x).hypot(ay + t * dy - y)
    }

    /// Twice the area between it and the point.
    fn cross(&self, [x, y]: [f64; 2]) -> f64 {
        let ([ax, ay], [bx, by]) = (self.from, self.to);
        (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    }
}

/// A triangle before a camera.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    corners: [Homogeneous; 3],
    /// Negative if its corners go counter-clockwise as seen from the eye, positive for clockwise.
    pub(crate) turn: f64,
    /// What is seen of it, a convex polygon on the screen.
    pub(crate) outline: Vec<Stretch>,
}

/// A facet at a point of the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// The shares of the corners, in space: their sum is 1.
    pub(crate) shares: [f64; 3],
    pub(crate) w: f64,
}

impl Hit {
    pub(crate) fn of(&self, values: [f64; 3]) -> f64 {
        dot(self.shares, values)
    }
}

impl Facet {
    /// The ray of a point of the screen meets the triangle's plane here, if it does before the eye.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> Option<Hit> {
        let [a, b, c] = self.corners.map(|[cx, cy, divisor, _]| [cx - x * divisor, cy - y * divisor]);
        let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let shares = [cross(b, c), cross(c, a), cross(a, b)];
        let sum: f64 = shares.iter().sum();
        let shares = shares.map(|share| share / sum);
        let divisor = dot(shares, self.corners.map(|corner| corner[2]));
        let hit = Hit { shares, w: dot(shares, self.corners.map(|corner| corner[3])) };
        (divisor > 0.0 && divisor.is_finite()).then_some(hit)
    }

    /// How deep inside the outline a point of the screen lies, in pixels; outside, less than 0: −∞ if nothing of it is seen, and never inside
    /// one without area.
    pub(crate) fn depth(&self, point: [f64; 2]) -> f64 {
        let distance = self.outline.iter().map(|side| side.distance(point)).fold(f64::INFINITY, f64::min);
        let inside = self.turn != 0.0
            && !self.outline.is_empty()
            && self.outline.iter().all(|side| side.cross(point) * self.turn >= 0.0);
        if inside { distance } else { -distance }
    }

    /// The least distance of a corner of the outline from the line through the two beside it: one of less
    /// than twice what corners are moved may be turned over.
    pub(crate) fn thickness(&self) -> f64 {
        let count = self.outline.len();
        (0..count)
            .map(|i| {
                let before = self.outline[(i + count - 1) % count].from;
                let side = Stretch { from: before, to: self.outline[i].to, ..self.outline[i] };
                let length = (side.to[0] - before[0]).hypot(side.to[1] - before[1]);
                side.cross(self.outline[i].from).abs() / length
            })
            .fold(f64::INFINITY, |least, next| {
                if next < least || next.is_nan() { if next.is_nan() { 0.0 } else { next } } else { least }
            })
    }

    /// Largest over smallest w of what is seen.
    pub(crate) fn w_ratio(&self) -> f64 {
        let w = || self.outline.iter().map(|side| side.w);
        w().fold(0.0, f64::max) / w().fold(f64::INFINITY, f64::min)
    }
}
