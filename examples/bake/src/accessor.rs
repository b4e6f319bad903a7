//! Numbers of glTF files, out of buffers that may be too short: checked here, where the crate `gltf` would panic.

use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

/// More numbers than any file that is meant for this has.
const MOST: usize = 1 << 26;

/// The numbers of an accessor, `N` an element; normalised integers as −1 … 1 or 0 … 1.
pub(crate) fn read<const N: usize>(
    accessor: &Accessor<'_>,
    buffers: &[Vec<u8>],
) -> Result<Vec<[f64; N]>, String> {
    let name = format!("accessor {}", accessor.index());
    if accessor.dimensions().multiplicity() != N || is_matrix(accessor.dimensions()) {
        return Err(format!(
            "{name} has elements of {:?}, where {N} numbers are meant",
            accessor.dimensions()
        ));
    }
    let count = accessor.count();
    if count > MOST {
        return Err(format!("{name} has {count} elements"));
    }
    let (kind, is_normalized) = (accessor.data_type(), accessor.normalized());
    let mut found = match accessor.view() {
        Some(view) => elements::<N>(&view, accessor.offset(), count, kind, is_normalized, buffers)
            .ok_or_else(|| format!("{name} reaches beyond its buffer"))?,
        None => vec![[0.0; N]; count],
    };
    if let Some(sparse) = accessor.sparse() {
        let too_short = || format!("what {name} has in other places reaches beyond its buffer");
        let (indices, values) = (sparse.indices(), sparse.values());
        let kind_of_index = match indices.index_type() {
            gltf::accessor::sparse::IndexType::U8 => DataType::U8,
            gltf::accessor::sparse::IndexType::U16 => DataType::U16,
            gltf::accessor::sparse::IndexType::U32 => DataType::U32,
        };
        if sparse.count() > MOST {
            return Err(too_short());
        }
        let places =
            elements_of::<1>(&indices.view(), indices.offset(), sparse.count(), kind_of_index, buffers)
                .ok_or_else(too_short)?;
        let values =
            elements::<N>(&values.view(), values.offset(), sparse.count(), kind, is_normalized, buffers)
                .ok_or_else(too_short)?;
        for ([place], value) in places.iter().zip(values) {
            let element = found.get_mut(*place as usize).ok_or_else(too_short)?;
            *element = value;
        }
    }
    Ok(found)
}

fn is_matrix(dimensions: Dimensions) -> bool {
    matches!(dimensions, Dimensions::Mat2 | Dimensions::Mat3 | Dimensions::Mat4)
}

fn elements_of<const N: usize>(
    view: &View<'_>,
    offset: usize,
    count: usize,
    kind: DataType,
    buffers: &[Vec<u8>],
) -> Option<Vec<[f64; N]>> {
    elements(view, offset, count, kind, false, buffers)
}

/// `None` if the buffer is too short.
fn elements<const N: usize>(
    view: &View<'_>,
    offset: usize,
    count: usize,
    kind: DataType,
    is_normalized: bool,
    buffers: &[Vec<u8>],
) -> Option<Vec<[f64; N]>> {
    let bytes = bytes(view, buffers)?;
    let size = kind.size();
    let stride = view.stride().unwrap_or(N * size);
    let mut found = Vec::new();
    for i in 0..count {
        let start = i.checked_mul(stride)?.checked_add(offset)?;
        let element = bytes.get(start..start.checked_add(N * size)?)?;
        let mut numbers = [0.0; N];
        for (number, bytes) in numbers.iter_mut().zip(element.chunks_exact(size)) {
            *number = number_of(bytes, kind, is_normalized)?;
        }
        found.push(numbers);
    }
    Some(found)
}

/// The bytes of a view.
pub(crate) fn bytes<'b>(view: &View<'_>, buffers: &'b [Vec<u8>]) -> Option<&'b [u8]> {
    let buffer = buffers.get(view.buffer().index())?;
    buffer.get(view.offset()..view.offset().checked_add(view.length())?)
}

fn number_of(bytes: &[u8], kind: DataType, is_normalized: bool) -> Option<f64> {
    let (number, most) = match kind {
        DataType::I8 => (f64::from(*bytes.first()? as i8), 127.0),
        DataType::U8 => (f64::from(*bytes.first()?), 255.0),
        DataType::I16 => (f64::from(i16::from_le_bytes(*bytes.first_chunk()?)), 32767.0),
        DataType::U16 => (f64::from(u16::from_le_bytes(*bytes.first_chunk()?)), 65535.0),
        DataType::U32 => (f64::from(u32::from_le_bytes(*bytes.first_chunk()?)), 4_294_967_295.0),
        DataType::F32 => return Some(f32::from_le_bytes(*bytes.first_chunk()?).into()),
    };
    Some(if is_normalized { (number / most).max(-1.0) } else { number })
}
