//! What a module writes into the host's region. `repr(C)` is the layout of the ABI; bytes are little-endian.

use core::mem::offset_of;

macro_rules! record {
    ($(#[$doc:meta])* $name:ident, $bytes:literal: $($(#[$field_doc:meta])* $field:ident: $type:ty,)+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        #[repr(C)]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $type,)+
        }

        impl $name {
            /// How long a record is.
            pub const BYTES: usize = $bytes;

            /// Reads a record.
            #[inline(always)]
            pub fn from_bytes(bytes: &[u8; $bytes]) -> Self {
                Self { $($field: Words::read(bytes, offset_of!(Self, $field)),)+ }
            }

            /// Writes a record.
            #[inline(always)]
            pub fn to_bytes(&self) -> [u8; $bytes] {
                let mut bytes = [0; $bytes];
                $(self.$field.write(&mut bytes, offset_of!(Self, $field));)+
                bytes
            }
        }

        const _: () = assert!(size_of::<$name>() == $bytes && align_of::<$name>() == 4);
    };
}

record! {
    /// What the smooth lobes do between a pair of directions.
    EvalOut, 20:
    /// f · |cos θ_i|, 1/sr; at 0.
    value: [f32; 3],
    /// How densely `bsdf_sample` makes ω_i from ω_o, per steradian, over all smooth lobes; at 12.
    pdf: f32,
    /// How densely it makes ω_o from ω_i; at 16.
    pdf_rev: f32,
}

record! {
    /// A sampled direction.
    SampleOut, 40:
    /// Unit, away from the surface; at 0.
    wi: [f32; 3],
    /// f · |cos θ_i| / pdf; at 12.
    weight: [f32; 3],
    /// As in [`EvalOut`]; of a delta lobe, the chance of picking it; at 24.
    pdf: f32,
    /// As in [`EvalOut`]; of a delta lobe, the chance with ω_i and ω_o swapped; at 28.
    pdf_rev: f32,
    /// The one lobe's bit; 0: no sample; at 32.
    lobe: u32,
    /// Index of refraction on ω_i's side / on ω_o's side; 0 or 1: not refracted; at 36.
    eta: f32,
}

record! {
    /// One of many pairs of directions, and the answer.
    EvalRecord, 44:
    /// At 0.
    wo: [f32; 3],
    /// At 12.
    wi: [f32; 3],
    /// At 24.
    out: EvalOut,
}

record! {
    /// What the smooth lobes do between a pair of directions, and a sampled direction.
    VertexOut, 60:
    /// At 0.
    eval: EvalOut,
    /// At 20.
    sample: SampleOut,
}

record! {
    /// A sampled direction of emission.
    EmitOut, 28:
    /// Unit; it leaves the light; at 0.
    direction: [f32; 3],
    /// W/(m² sr), or W/sr of a point light; at 12.
    radiance: [f32; 3],
    /// Per steradian; 0: nothing leaves; at 24.
    pdf: f32,
}

record! {
    /// What leaves along a direction.
    ProfileOut, 16:
    /// W/(m² sr), or W/sr of a point light; at 0.
    radiance: [f32; 3],
    /// How densely `light_emit` makes the direction, per steradian; at 12.
    pdf: f32,
}

/// A field, somewhere in the bytes of a record.
trait Words {
    fn read(bytes: &[u8], at: usize) -> Self;
    fn write(&self, bytes: &mut [u8], at: usize);
}

macro_rules! word {
    ($($type:ty),+) => {$(
        impl Words for $type {
            #[inline(always)]
            fn read(bytes: &[u8], at: usize) -> Self {
                bytes[at..].first_chunk().copied().map(Self::from_le_bytes).unwrap_or_default()
            }
            #[inline(always)]
            fn write(&self, bytes: &mut [u8], at: usize) {
                bytes[at..at + 4].copy_from_slice(&self.to_le_bytes());
            }
        }
    )+};
}

word! { f32, u32 }

impl Words for [f32; 3] {
    #[inline(always)]
    fn read(bytes: &[u8], at: usize) -> Self {
        [Words::read(bytes, at), Words::read(bytes, at + 4), Words::read(bytes, at + 8)]
    }
    #[inline(always)]
    fn write(&self, bytes: &mut [u8], at: usize) {
        self.iter().enumerate().for_each(|(i, component)| component.write(bytes, at + 4 * i));
    }
}

macro_rules! inner {
    ($($type:ident),+) => {$(
        impl Words for $type {
            #[inline(always)]
            fn read(bytes: &[u8], at: usize) -> Self {
                bytes[at..].first_chunk().map(Self::from_bytes).unwrap_or_default()
            }
            #[inline(always)]
            fn write(&self, bytes: &mut [u8], at: usize) {
                bytes[at..at + Self::BYTES].copy_from_slice(&self.to_bytes());
            }
        }
    )+};
}

inner! { EvalOut, SampleOut }

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_lie_where_the_abi_page_puts_them() {
        assert_eq!([offset_of!(EvalOut, value), offset_of!(EvalOut, pdf), offset_of!(EvalOut, pdf_rev)], [0, 12, 16]);
        assert_eq!([offset_of!(SampleOut, wi), offset_of!(SampleOut, weight)], [0, 12]);
        assert_eq!([offset_of!(SampleOut, pdf), offset_of!(SampleOut, pdf_rev)], [24, 28]);
        assert_eq!([offset_of!(SampleOut, lobe), offset_of!(SampleOut, eta)], [32, 36]);
        assert_eq!([offset_of!(EvalRecord, wo), offset_of!(EvalRecord, wi), offset_of!(EvalRecord, out)], [0, 12, 24]);
        assert_eq!([offset_of!(VertexOut, eval), offset_of!(VertexOut, sample)], [0, 20]);
        assert_eq!([offset_of!(EmitOut, direction), offset_of!(EmitOut, radiance), offset_of!(EmitOut, pdf)], [0, 12, 24]);
        assert_eq!([offset_of!(ProfileOut, radiance), offset_of!(ProfileOut, pdf)], [0, 12]);
    }

    #[test]
    fn a_record_is_written_little_endian_in_the_order_of_its_fields() {
        let sample = SampleOut { wi: [1.0, 2.0, 3.0], weight: [4.0, 5.0, 6.0], pdf: 7.0, pdf_rev: 8.0, lobe: 0x0102_0304, eta: 1.5 };
        let bytes = sample.to_bytes();
        assert_eq!(bytes[0..4], [0, 0, 0x80, 0x3f]);
        assert_eq!(bytes[32..36], [4, 3, 2, 1]);
        assert_eq!(bytes[36..40], [0, 0, 0xc0, 0x3f]);
        assert_eq!(SampleOut::from_bytes(&bytes), sample);
    }

    #[test]
    fn a_record_in_a_record_reads_back() {
        let out = EvalOut { value: [0.25, 0.5, 0.75], pdf: 1.0, pdf_rev: 2.0 };
        let record = EvalRecord { wo: [0.0, 0.6, 0.8], wi: [0.0, -0.6, 0.8], out };
        assert_eq!(EvalRecord::from_bytes(&record.to_bytes()), record);
        assert_eq!(record.to_bytes()[24..], out.to_bytes());
    }
}
