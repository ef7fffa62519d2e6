//! Numbers out of buffers: every offset, stride and count is checked once, before the first number is read.

use super::file::{File, slice};
use crate::Error;
use gltf::json::accessor::{Accessor as Json, ComponentType, Type, sparse};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Index, buffer};

/// An accessor without a buffer view holds zeros, as many as it likes; this many we believe.
const MOST_ZEROS: u64 = 1 << 24;

/// Elements of up to four numbers each. What an element does not have (alpha, say) reads as zero.
pub struct Accessor<'a> {
    pub count: usize,
    components: usize,
    /// `None` for zeros.
    base: Option<Elements<'a>>,
    /// Indices in rising order, and the elements that replace those of the base.
    sparse: Option<(Vec<usize>, Elements<'a>)>,
    /// Greatest value of the integer type, if it stands for 1.
    one: Option<f64>,
}

/// Elements at a regular distance.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: ComponentType,
}

impl<'a> Accessor<'a> {
    /// The accessor `index` of `file`, wanted by `place`, which takes elements of these `types`.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it does not exist, has another type, or reaches beyond its buffer.
    pub fn new(file: &'a File, index: Index<Json>, place: &str, types: &[Type]) -> Result<Accessor<'a>, Error> {
        let json = file.get(&file.root.accessors, index, "accessors", place)?;
        let error = |what: String| file.error(place, format!("accessors/{}: {what}", index.value()));
        let (Checked::Valid(component), Checked::Valid(kind)) = (json.component_type, json.type_) else {
            return Err(error("its type or componentType is none that glTF knows".into()));
        };
        if !types.contains(&kind) {
            return Err(error(format!("elements of type {kind:?} make no sense here, only {types:?}")));
        }
        let (component, components) = (component.0, kind.multiplicity());
        let base = match json.buffer_view {
            Some(view) => {
                let offset = json.byte_offset.unwrap_or_default();
                Some(Elements::new(file, view, offset, json.count, component, components, place)?)
            }
            None if json.count.0 <= MOST_ZEROS => None,
            None => return Err(error(format!("{} elements without a bufferView are too many", json.count.0))),
        };
        let one = if json.normalized { greatest(component) } else { None };
        let mut accessor = Accessor { count: json.count.0 as usize, components, base, sparse: None, one };
        if let Some(sparse) = &json.sparse {
            accessor.sparse = Some(accessor.read_sparse(file, sparse, component, place)?);
        }
        Ok(accessor)
    }

    fn read_sparse(
        &self,
        file: &'a File,
        json: &sparse::Sparse,
        component: ComponentType,
        place: &str,
    ) -> Result<(Vec<usize>, Elements<'a>), Error> {
        let place = format!("{place}/sparse");
        let Checked::Valid(index_component) = json.indices.component_type else {
            return Err(file.error(&place, "the componentType of its indices is none that glTF knows"));
        };
        let (view, offset) = (json.indices.buffer_view, json.indices.byte_offset);
        let indices = Elements::new(file, view, offset, json.count, index_component.0, 1, &place)?;
        let (view, offset) = (json.values.buffer_view, json.values.byte_offset);
        let values = Elements::new(file, view, offset, json.count, component, self.components, &place)?;
        let indices: Vec<usize> = (0..json.count.0 as usize).map(|i| indices.number(i, 0) as usize).collect();
        if !indices.is_sorted_by(|a, b| a < b) || indices.last().is_some_and(|&last| last >= self.count) {
            return Err(file.error(&place, format!("its indices must rise and stay below {}", self.count)));
        }
        Ok((indices, values))
    }

    /// Element `i`, which must be below `count`.
    pub fn get(&self, i: usize) -> [f64; 4] {
        let replaced =
            self.sparse.as_ref().and_then(|(indices, values)| Some((values, indices.binary_search(&i).ok()?)));
        let Some((elements, i)) = replaced.or(self.base.as_ref().map(|base| (base, i))) else { return [0.0; 4] };
        let mut element = [0.0; 4];
        for (k, number) in element.iter_mut().enumerate().take(self.components) {
            let plain = elements.number(i, k);
            *number = self.one.map_or(plain, |one| (plain / one).max(-1.0));
        }
        element
    }

    /// Reads integers as parts of their greatest value, whether the file says so or not.
    pub fn normalized(mut self) -> Accessor<'a> {
        self.one = self.base.as_ref().and_then(|elements| greatest(elements.component));
        self
    }
}

impl<'a> Elements<'a> {
    fn new(
        file: &'a File,
        view: Index<buffer::View>,
        offset: USize64,
        count: USize64,
        component: ComponentType,
        components: usize,
        place: &str,
    ) -> Result<Elements<'a>, Error> {
        let (bytes, stride) = file.view(view, place)?;
        let size = component.size() * components;
        let stride = stride.filter(|&stride| stride > 0).unwrap_or(size);
        let needed = match count.0 {
            0 => Some(0),
            n => (n - 1).checked_mul(stride as u64).and_then(|bytes| bytes.checked_add(size as u64)),
        };
        let fitting = needed.and_then(|needed| slice(bytes, offset, USize64(needed)));
        let bytes = fitting.ok_or_else(|| {
            let (view, there) = (view.value(), bytes.len());
            let what = format!(
                "{} elements of {size} bytes, {stride} apart, from byte {} do not fit into the {there} bytes of bufferViews/{view}",
                count.0, offset.0
            );
            file.error(place, what)
        })?;
        Ok(Elements { bytes, stride, component })
    }

    /// Component `k` of element `i`.
    fn number(&self, i: usize, k: usize) -> f64 {
        let at = i * self.stride + k * self.component.size();
        let b = &self.bytes[at..at + self.component.size()];
        match self.component {
            ComponentType::I8 => f64::from(b[0].cast_signed()),
            ComponentType::U8 => f64::from(b[0]),
            ComponentType::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            ComponentType::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            ComponentType::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            ComponentType::F32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        }
    }
}

/// Greatest value of an integer type.
fn greatest(component: ComponentType) -> Option<f64> {
    match component {
        ComponentType::I8 => Some(f64::from(i8::MAX)),
        ComponentType::U8 => Some(f64::from(u8::MAX)),
        ComponentType::I16 => Some(f64::from(i16::MAX)),
        ComponentType::U16 => Some(f64::from(u16::MAX)),
        ComponentType::U32 => Some(f64::from(u32::MAX)),
        ComponentType::F32 => None,
    }
}
