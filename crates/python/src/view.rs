//! Arrays: views on memory that Rust owns, and arrays from Python.
//!
//! A view is a read-only NumPy array whose base is the object that owns the memory: nothing is copied, and the memory lives as long as
//! any view on it.

// What NumPy sees of memory cannot be checked by the compiler.
#![allow(unsafe_code)]

use crate::fail::Fail;
use isolux_core::Error;
use isolux_core::math::Rgb;
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;

/// What `values` names of `owner`, as an array of shape (n,).
pub fn view<'py, O, T>(owner: &Bound<'py, O>, values: impl for<'a> FnOnce(&'a O) -> &'a [T]) -> Bound<'py, PyArray1<T>>
where
    O: PyClass<Frozen = True> + Sync,
    T: Element,
{
    let values = ArrayView1::from(values(owner.get()));
    // SAFETY: the memory belongs to `owner`, which never changes what it has once made (frozen), and becomes the base of the array.
    let array = unsafe { PyArray1::borrow_from_array(&values, owner.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    array
}

/// What `values` names of `owner`, as an array of shape (n, 3).
pub fn view_of_triples<'py, O>(
    owner: &Bound<'py, O>,
    values: impl for<'a> FnOnce(&'a O) -> &'a [[f32; 3]],
) -> Bound<'py, PyArray2<f32>>
where
    O: PyClass<Frozen = True> + Sync,
{
    let values = ArrayView2::from(values(owner.get()));
    // SAFETY: as above.
    let array = unsafe { PyArray2::borrow_from_array(&values, owner.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    array
}

/// Colours as the three numbers that they are.
pub fn triples(colors: &[Rgb]) -> &[[f32; 3]] {
    // SAFETY: a colour is `repr(C)` with three 32-bit channels, so it has the size and the alignment of an array of them.
    unsafe { std::slice::from_raw_parts(colors.as_ptr().cast(), colors.len()) }
}

/// Whether a slice is all of the array's rows, of `N` numbers each.
pub fn rows<'a, T: Element, const N: usize>(
    array: &'a PyReadonlyArray2<T>,
    name: &'static str,
) -> Result<&'a [[T; N]], Fail> {
    let shape = [array.shape()[0], array.shape()[1]];
    let whole = array.as_slice().ok().filter(|_| shape[1] == N).map(|numbers| numbers.as_chunks::<N>().0);
    whole.ok_or_else(|| {
        let allowed = "an array in C order with one row for each, as the docstring says";
        Error::Parameter { name, value: format!("shape {shape:?}"), allowed }.into()
    })
}

/// All numbers of an array.
pub fn numbers<'a, T: Element>(array: &'a PyReadonlyArray1<T>, name: &'static str) -> Result<&'a [T], Fail> {
    let refused = |_| Error::Parameter { name, value: "strided".to_owned(), allowed: "a contiguous array" };
    Ok(array.as_slice().map_err(refused)?)
}
