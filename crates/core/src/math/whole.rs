//! Whole parts of numbers, by additions and comparisons alone.
//!
//! A cast to an integer that takes any number for the nearest possible one is several instructions, and compilers do not do it for
//! several numbers at once. Adding 2²³ instead leaves a float no bits behind the point. All functions are exact, and the same
//! bits whatever the instructions.

/// Numbers from here on have no bits for fractions.
const WHOLE: f32 = (1u32 << 23) as f32;

/// The greatest whole number that is not greater than `x`; 0 for what is negative or not a number, 65,535 for what is greater.
#[inline(always)]
pub fn whole(x: f32) -> f32 {
    let x = smaller(if x > 0.0 { x } else { 0.0 }, 65_535.0);
    let nearest = (x + WHOLE) - WHOLE;
    nearest - if nearest > x { 1.0 } else { 0.0 }
}

/// A whole number from 0 to 2²³ - 1 as an integer.
#[inline(always)]
pub fn number(whole: f32) -> u32 {
    (whole + WHOLE).to_bits() - WHOLE.to_bits()
}

/// The smaller of two numbers, in one instruction: the second one if they cannot be compared.
#[inline(always)]
pub fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_parts_are_those_of_casts() {
        let near = |x: f32| [x.next_down(), x, x.next_up(), x + 0.5, x + 0.25];
        let many = (0..70_000).flat_map(|k| near(k as f32)).chain([-0.0, -0.5, -1e9, 1e9, f32::INFINITY, f32::NAN]);
        for x in many {
            let expected = x as u16;
            assert_eq!((whole(x), number(whole(x))), (f32::from(expected), u32::from(expected)), "{x}");
        }
        assert_eq!(number(8_388_607.0), 8_388_607);
        assert_eq!([smaller(1.0, 2.0), smaller(2.0, 1.0), smaller(f32::NAN, 1.0)], [1.0; 3]);
    }
}
