// Reads Parquet files by two independent readers and prints, a line a file and reader, its rows, the sums of its numbers and
// its last row. They come from the npm registry, into any folder:
//
//   npm install --prefix READERS hyparquet hyparquet-compressors parquet-wasm apache-arrow
//   node tools/check_parquet.mjs READERS FILE...
import { readFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { resolve } from 'node:path'
import { pathToFileURL } from 'node:url'

const [readers, ...files] = process.argv.slice(2)
if (!readers || files.length === 0) {
  console.error('usage: node check_parquet.mjs READERS FILE...')
  process.exit(2)
}
const require = createRequire(pathToFileURL(resolve(readers, 'node_modules', 'x.js')))
const load = (name) => import(pathToFileURL(require.resolve(name)).href)

function summary(rows) {
  const sums = {}
  for (const row of rows)
    for (const [name, value] of Object.entries(row))
      if (typeof value === 'number') sums[name] = (sums[name] ?? 0) + value
  for (const name of Object.keys(sums)) sums[name] = Number(sums[name].toFixed(1))
  return JSON.stringify({ rows: rows.length, sums, last: rows[rows.length - 1] })
}

const { parquetReadObjects } = await load('hyparquet')
const { compressors } = await load('hyparquet-compressors')
const wasm = require('parquet-wasm')
const arrow = require('apache-arrow')
for (const file of files) {
  const bytes = readFileSync(file)
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength)
  console.log('hyparquet', summary(await parquetReadObjects({ file: buffer, compressors })))
  const table = arrow.tableFromIPC(wasm.readParquet(new Uint8Array(bytes)).intoIPCStream())
  console.log('parquet-wasm', summary(table.toArray().map((row) => row.toJSON())))
}
