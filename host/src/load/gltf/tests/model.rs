//! Small glTFs, put together in memory.

use std::io::Cursor;

use serde_json::{Value, json};

/// A glTF in the making, with one buffer and one scene.
pub struct Model {
    json: Value,
    bytes: Vec<u8>,
    roots: Vec<usize>,
}

impl Default for Model {
    fn default() -> Self {
        Self { json: json!({"asset": {"version": "2.0"}}), bytes: Vec::new(), roots: Vec::new() }
    }
}

impl Model {
    /// Adds to one of the file's lists; its number there.
    pub fn add(&mut self, list: &str, value: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let all = self.json[list].as_array_mut().expect("a list");
        all.push(value);
        all.len() - 1
    }

    /// Says something at the outermost level.
    pub fn set(&mut self, name: &str, value: Value) {
        self.json[name] = value;
    }

    /// Puts bytes into the buffer.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend(bytes);
        self.add("bufferViews", view)
    }

    /// An accessor of vectors.
    pub fn vectors<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        self.add("accessors", json!({"bufferView": view, "componentType": 5126, "type": kind, "count": values.len()}))
    }

    /// An accessor of indices, 16 bits each.
    pub fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.add("accessors", json!({"bufferView": view, "componentType": 5123, "type": "SCALAR", "count": values.len()}))
    }

    /// A square from −1 to 1 in x and y that faces +z, with an image's upper left corner at −1, 1; `more` is what else its primitive says.
    pub fn square(&mut self, more: Value) -> usize {
        let positions = self.vectors(&SQUARE);
        let uvs = self.vectors(&SQUARE_UVS);
        let indices = self.indices(&[0, 1, 2, 0, 2, 3]);
        let mut primitive = json!({"attributes": {"POSITION": positions, "TEXCOORD_0": uvs}, "indices": indices});
        for (name, value) in more.as_object().into_iter().flatten() {
            primitive[name] = value.clone();
        }
        self.add("meshes", json!({"primitives": [primitive]}))
    }

    /// A texture of 8-bit pixels, red, green, blue and alpha.
    pub fn texture(&mut self, width: u32, pixels: &[[u8; 4]]) -> usize {
        let view = self.view(&png(width, pixels));
        let image = self.add("images", json!({"bufferView": view, "mimeType": "image/png"}));
        self.add("textures", json!({"source": image}))
    }

    /// A node that the scene begins with.
    pub fn node(&mut self, node: Value) -> usize {
        let index = self.add("nodes", node);
        self.roots.push(index);
        index
    }

    fn finished(&self, uri: Option<String>) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["scenes"].is_null() {
            json["scenes"] = json!([{"nodes": self.roots}]);
        }
        if json["buffers"].is_null() {
            json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
            if let Some(uri) = uri {
                json["buffers"][0]["uri"] = json!(uri);
            }
        }
        json.to_string().into_bytes()
    }

    /// As a `.gltf` that holds its buffer.
    pub fn gltf(&self) -> Vec<u8> {
        self.finished(Some(format!("data:application/octet-stream;base64,{}", base64(&self.bytes))))
    }

    /// As a `.gltf` whose buffer is in a file, and what is in that.
    pub fn beside(&self, uri: &str) -> (Vec<u8>, &[u8]) {
        (self.finished(Some(uri.to_owned())), &self.bytes)
    }

    /// As a `.glb`.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.finished(None);
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut binary = self.bytes.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
        let total = (12 + 8 + json.len() + 8 + binary.len()) as u32;
        [&b"glTF"[..], &2_u32.to_le_bytes(), &total.to_le_bytes(), &length(&json), b"JSON", &json, &length(&binary), b"BIN\0", &binary]
            .concat()
    }
}

/// Corners, counter-clockwise.
pub const SQUARE: [[f32; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
/// An image's upper edge is at v = 0.
pub const SQUARE_UVS: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];

/// A PNG.
pub fn png(width: u32, pixels: &[[u8; 4]]) -> Vec<u8> {
    let image = image::RgbaImage::from_raw(width, pixels.len() as u32 / width, pixels.concat()).expect("an image");
    let mut bytes = Vec::new();
    image.write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png).expect("a PNG");
    bytes
}

/// RFC 4648.
pub fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let bits = (0..3).fold(0_u32, |bits, i| bits << 8 | u32::from(group.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            text.push(if i <= group.len() { char::from(LETTERS[(bits >> (18 - 6 * i) & 63) as usize]) } else { '=' });
        }
    }
    text
}
