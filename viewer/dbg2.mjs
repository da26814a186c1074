import {chromium} from 'playwright-core';
const b=await chromium.launch({executablePath:'/usr/bin/chromium',args:['--headless','--no-sandbox','--use-angle=swiftshader','--enable-unsafe-swiftshader']});
const p=await b.newPage({viewport:{width:1280,height:800},colorScheme:'dark'});
p.on('console',m=>console.log(m.text()));
await p.goto('file:///tmp/vt/pyramid.html');
await p.waitForTimeout(1500);
const settle = (page) =>
    page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30)))));
for(const t of [6/60,6.5/60,7/60,0.2]) { await p.evaluate(t=>avbdViewer.seek(t),t); await settle(p); console.log(t, JSON.stringify(await p.evaluate(()=>[avbdViewer.time,avbdViewer.frame,...avbdViewer.poseOf(5)]))); }
const t0=Date.now();
for(const q of ['0','1','2','3','4']){ await p.evaluate(q=>{avbdViewer.setQuality(q);avbdViewer.play()},q); await p.waitForTimeout(1000); await p.evaluate(()=>{let s=avbdViewer; }); await p.waitForTimeout(4000); console.log(q, JSON.stringify(await p.evaluate(()=>avbdViewer.stats)));}
await b.close();
