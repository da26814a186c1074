// CPU time of the GPU process a picture.
import {chromium} from 'playwright-core';
import {readFileSync, readdirSync} from 'node:fs';
import {mkdtempSync} from 'node:fs';
const dir=mkdtempSync('/tmp/vt/prof');
const b=await chromium.launchPersistentContext(dir,{executablePath:'/usr/bin/chromium',viewport:{width:1280,height:800},colorScheme:'dark',args:['--headless','--no-sandbox','--use-angle=swiftshader','--enable-unsafe-swiftshader',...(process.argv[4]?process.argv[4].split(','):[])]});
const cpu=()=>{let t=0;for(const d of readdirSync('/proc')){ if(!/^\d+$/.test(d)) continue; try{const c=readFileSync(`/proc/${d}/cmdline`,'latin1'); if(!c.includes('--type=gpu-process')||!c.includes(dir)) continue; const s=readFileSync(`/proc/${d}/stat`,'latin1').split(') ')[1].split(' '); t+=Number(s[11])+Number(s[12]);}catch{}} return t*10;};
const p=await b.newPage();
p.on('console',m=>console.log(m.text()));
await p.goto('file://'+process.argv[2]);
await p.waitForFunction(()=>window.avbdViewer);
for(const q of (process.argv[3]??'0,2,3,4').split(',')){ await p.evaluate(q=>{avbdViewer.setQuality(q);avbdViewer.play();},q); await p.waitForTimeout(1500);
 await p.evaluate(()=>{window.n=0;const f=()=>{++window.n;requestAnimationFrame(f)};requestAnimationFrame(f)});
 const c0=cpu(),t0=Date.now(); const n0=await p.evaluate(()=>window.n); await p.waitForTimeout(4000); const n1=await p.evaluate(()=>window.n); const c1=cpu(); console.log(q,'frames',n1-n0,'wall ms/frame',((Date.now()-t0)/(n1-n0)).toFixed(0),'gpu-process cpu ms/frame',((c1-c0)/(n1-n0)).toFixed(0), JSON.stringify(await p.evaluate(()=>avbdViewer.stats))); await p.evaluate(()=>avbdViewer.pause()); 
 await p.reload(); await p.waitForFunction(()=>window.avbdViewer);}
await b.close();
