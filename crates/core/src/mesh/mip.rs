//! Smaller and smaller versions of an image (Williams 1983), for averages over large footprints.
//!
//! Every level is the exact box average of the whole image on fewer texels, for any size, so all have the image's mean.
//! As every level spans [0, 1] in both directions, wrap modes mean the same on all of them.

use crate::math::Rgb;
use crate::scene::Image;

/// An image and its smaller versions.
pub struct Mips<'a> {
    image: &'a Image,
    /// Each half as wide and high as the one before, rounded down, until there is one texel.
    smaller: Vec<Level>,
}

struct Level {
    size: [u32; 2],
    /// Linear.
    texels: Vec<Rgb>,
}

impl<'a> Mips<'a> {
    pub fn new(image: &'a Image) -> Mips<'a> {
        let mut mips = Mips { image, smaller: Vec::new() };
        while mips.size(mips.last()) != [1, 1] {
            let level = mips.halved(mips.last());
            mips.smaller.push(level);
        }
        mips
    }

    /// Number of the level that is one texel.
    pub fn last(&self) -> usize {
        self.smaller.len()
    }

    /// Width and height of a level; level 0 is the image itself.
    pub fn size(&self, level: usize) -> [u32; 2] {
        match level {
            0 => [self.image.width, self.image.height],
            _ => self.smaller[level - 1].size,
        }
    }

    /// Linear colour of a texel.
    pub fn texel(&self, level: usize, x: u32, y: u32) -> Rgb {
        match level {
            0 => self.image.texel(x, y),
            _ => {
                let Level { size: [width, _], texels } = &self.smaller[level - 1];
                texels[y as usize * *width as usize + x as usize]
            }
        }
    }

    fn halved(&self, level: usize) -> Level {
        let [width, height] = self.size(level);
        let size = [(width / 2).max(1), (height / 2).max(1)];
        let columns: Vec<_> = (0..size[0]).map(|x| weights(x, width, size[0])).collect();
        let mut texels = Vec::with_capacity(size[0] as usize * size[1] as usize);
        for y in 0..size[1] {
            let rows = weights(y, height, size[1]);
            for columns in &columns {
                let row_mean = |y| columns.iter().map(|&(x, share)| self.texel(level, x, y) * share).sum::<Rgb>();
                texels.push(rows.iter().map(|&(y, share)| row_mean(y) * share).sum());
            }
        }
        Level { size, texels }
    }
}

/// The texels of an axis of `size` that texel `k` of the same axis with `fewer` covers, each with its share of it.
fn weights(k: u32, size: u32, fewer: u32) -> Vec<(u32, f32)> {
    let scale = f64::from(size) / f64::from(fewer);
    let (low, high) = (f64::from(k) * scale, f64::from(k + 1) * scale);
    let covered = |x: u32| high.min(f64::from(x + 1)) - low.max(f64::from(x));
    let range = (low.floor() as u32)..(high.ceil() as u32).min(size);
    range.map(|x| (x, (covered(x).max(0.0) / scale) as f32)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_has_the_mean_of_the_image() {
        for (width, height) in [(1, 1), (2, 2), (7, 5), (1, 9), (64, 3)] {
            let texels = (0..width * height).map(|k| [(k * 89 % 256) as u8, (k * 57 % 256) as u8, 255]).collect();
            let image = Image { name: String::new(), width, height, texels };
            let mips = Mips::new(&image);
            let mean = |level: usize| {
                let [w, h] = mips.size(level);
                let all = (0..w * h).map(|k| mips.texel(level, k % w, k / w)).sum::<Rgb>();
                all / (w * h) as f32
            };
            for level in 0..=mips.last() {
                assert!((mean(level) - mean(0)).map(f32::abs).max_channel() < 1e-5, "{width} x {height}, {level}");
            }
        }
    }
}
